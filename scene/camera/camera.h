#pragma once

#include <memory>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include <ImathVec.h>

#include "scene/camera/lens_system.h"
#include "scene/camera/model.h"
#include "scene/camera/perspective.h"
#include "scene/camera/probe.h"
#include "scene/shapes/motion.h"
#include "sensor/response/channel.h"

namespace abbe {

/// A camera: one of the closed list of kinds, each a `CameraModel`, and its pixels. `kind` holds the pose of
/// a moving camera at time 0, in render coordinates [m]. Times are fractions of the exposure, as in
/// `BasicRay`.
struct Camera {
  std::variant<Pinhole, ThinLens, IrradianceProbe, LensSystem> kind;
  int width = 1;
  int height = 1;
  double pixel_pitch = 1;                          ///< [m]
  std::shared_ptr<const Motion> motion = nullptr;  ///< Null if the camera does not move.

  [[nodiscard]] FilmGrid film() const { return {width, height, pixel_pitch}; }
};

// The functions of `CameraModel` for the kind of the camera, which explains them. Functions with a time, or
// with a ray and its time, use the camera's pose at that time; all others that at time 0. None of them
// throws.
[[nodiscard]] CameraRay sample_ray(const Camera& camera, Imath::V2f film, Imath::V2f lens,
                                   const SampledSpectrum& wavelengths_nm, int hero, float time);
[[nodiscard]] std::optional<CameraConnection> sample_towards(const Camera& camera, const Imath::V3f& point,
                                                             Imath::V2f lens,
                                                             const SampledSpectrum& wavelengths_nm,
                                                             float time);
[[nodiscard]] std::optional<CameraDensity> density(const Camera& camera, const Ray& ray,
                                                   const SampledSpectrum& wavelengths_nm,
                                                   LensRoute route = 0);
[[nodiscard]] double min_film_cosine(const Camera& camera);
[[nodiscard]] CameraTraits traits(const Camera& camera);
[[nodiscard]] const Imath::V3d& position(const Camera& camera);
[[nodiscard]] Imath::V3d center(const Camera& camera);
void translate(Camera& camera, const Imath::V3d& by);

/// True if the camera is an irradiance probe; see `CameraTraits::probe_acceptance`.
[[nodiscard]] bool is_probe(const Camera& camera);
/// Unit normal of a probe at one of its points, towards the incident light; both at time 0. Requires
/// `is_probe`.
[[nodiscard]] Imath::V3f probe_normal(const Camera& probe, const Imath::V3f& point);

/// Box around the points at which rays leave the camera, at all times [m].
[[nodiscard]] Imath::Box3d bounds(const Camera& camera);
/// Origin of a probe's ray at time 0, just off its surface, for film coordinates `uv`: fractions of width and
/// height in [0, 1]. Requires `is_probe`.
[[nodiscard]] Imath::V3f probe_point(const Camera& probe, Imath::V2f uv);

/// Connection for a light ray that hits the camera's opening by itself. `opening` is that of `CameraTraits`,
/// and `light` travels towards it; its length is ignored. Flux along the ray adds `weight` times the flux to
/// the irradiance of the pixel at `film`. `lens_point` is the hit, for a probe moved off its surface. Nothing
/// if the ray misses the opening, is not accepted by a probe, or its image falls outside the film. Ghosts are
/// not included.
[[nodiscard]] std::optional<CameraConnection> connection_through(const Camera& camera, const Opening& opening,
                                                                 const Ray& light,
                                                                 const SampledSpectrum& wavelengths_nm);

/// Samples a point at which light enters the lens on the way of a ghost, by two random numbers in [0, 1).
/// Point and normal are those at that time. Nothing if the camera has no ghosts.
[[nodiscard]] std::optional<GhostEntrance> sample_ghost(const Camera& camera, Imath::V2f lens, float time);
/// A copy of the camera without ghosts.
[[nodiscard]] Camera without_ghosts(Camera camera);

/// A world ray, at its time, in the rest frame of the camera: its pose at time 0. Unchanged if nothing moves.
[[nodiscard]] Ray ray_in_rest_frame(const Camera& camera, const Ray& ray);
/// World direction, at that time, of a direction that the camera has at time 0.
[[nodiscard]] Imath::V3d direction_at(const Camera& camera, const Imath::V3d& direction, float time);

/// World unit direction, at that time, of the picture's right; nothing for a probe. Let k be the propagation
/// direction of incoming light. With the result made perpendicular to k, k x right points up in the picture.
[[nodiscard]] std::optional<Imath::V3f> film_right(const Camera& camera, float time);

/// Weight [sr] of the ray from the center of the lens to a film position [pixels], at 550 nm, time 0 and
/// without ghosts. It is the irradiance per radiance of that ray, and represents that of the pixel without
/// sampling. 0 if the lens blocks the ray.
[[nodiscard]] double central_weight(const Camera& camera, Imath::V2f film);

/// Calls `sample_ray` for each sample, at lower cost for a lens system. `rays` has as many elements as
/// `samples`. The origin, direction and time of a ray of zero weight are arbitrary.
void sample_rays(const Camera& camera, std::span<const CameraSample> samples, std::span<CameraRay> rays);
/// The overload for a lens system at rest; rays keep their times.
void sample_rays(const LensSystem& camera, const FilmGrid& grid, std::span<const CameraSample> samples,
                 std::span<CameraRay> rays);

/// Effective radius of a thin lens's opening divided by the focus distance. For an opening with blades it is
/// the radius of the disc with the same mean square. At f/1 and life size, that disc gives the same mean
/// weight to within 4e-5 for five or more blades, 2e-4 for four and 1.4e-3 for three. 0 for all other cameras
/// and for focus at infinity, where all rays of a film position have one direction.
[[nodiscard]] double opening_tangent(const Camera& camera);

/// Mean weight [sr] of the rays of a film position [pixels], at 550 nm and time 0. It is the irradiance at
/// the position under uniform unit radiance. `opening_tangent` is the result of that function for `camera`;
/// if it is 0, the result is `central_weight`.
[[nodiscard]] double mean_weight(const Camera& camera, double opening_tangent, Imath::V2f film);

/// Distribution of the angles of incidence at a film position, or on a probe, under uniform radiance. `film`
/// is in pixels from the top left corner, in [0, width] x [0, height]. The result has at most 32 angles with
/// equal numbers of rays, by increasing angle, whose fractions of the irradiance add up to 1. The rays are
/// those of `sample_ray` over the lens at 550 nm, at time 0 and without ghosts. For a cone of numerical
/// aperture sin u that a lossless lens fills uniformly, the density is
///     (1/sin^2 u) 2 sin(theta) cos(theta) dtheta.
/// Empty if no light arrives.
[[nodiscard]] std::vector<Incidence> incidence_angles(const Camera& camera, Imath::V2f film);

}  // namespace abbe
