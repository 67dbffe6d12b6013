#pragma once

#include <memory>
#include <optional>
#include <variant>

#include <ImathVec.h>

#include "scene/camera/lens_system.h"
#include "scene/camera/model.h"
#include "scene/camera/pinhole.h"
#include "scene/camera/probe.h"
#include "scene/camera/thin_lens.h"
#include "scene/shapes/motion.h"

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

}  // namespace abbe
