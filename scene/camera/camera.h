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

/// What turns film positions into rays: the closed list of kinds, each a `CameraModel`, and the pixels. The
/// kind says how a camera that moves stands at time 0.
struct Camera {
  std::variant<Pinhole, ThinLens, Probe, LensSystem> kind;
  int width = 1;
  int height = 1;
  double pixel_pitch = 1;  ///< [m]
  std::shared_ptr<const Motion> motion = nullptr;

  [[nodiscard]] FilmGrid film() const { return {width, height, pixel_pitch}; }
};

// What `CameraModel` says of each; what has a time finds the camera where it is then, all else where it is at
// time 0.
[[nodiscard]] CameraRay sample_ray(const Camera& camera, Imath::V2f film, Imath::V2f lens,
                                   const SampledSpectrum& wavelengths_nm, int hero, float time);
[[nodiscard]] std::optional<CameraConnection> sample_towards(const Camera& camera, const Imath::V3f& point,
                                                             Imath::V2f lens,
                                                             const SampledSpectrum& wavelengths_nm,
                                                             float time);
[[nodiscard]] std::optional<CameraDensity> density(const Camera& camera, const Ray& ray,
                                                   const SampledSpectrum& wavelengths_nm,
                                                   LensRoute route = 0);
[[nodiscard]] double least_film_cosine(const Camera& camera);
[[nodiscard]] CameraTraits traits(const Camera& camera);
[[nodiscard]] const Imath::V3d& position(const Camera& camera);
[[nodiscard]] Imath::V3d middle(const Camera& camera);
void translate(Camera& camera, const Imath::V3d& by);

/// Whether the camera is a meter; see `CameraTraits::meter_acceptance`.
[[nodiscard]] bool is_meter(const Camera& camera);
/// The outward unit normal of a meter at one of its points.
[[nodiscard]] Imath::V3f meter_normal(const Camera& meter, const Imath::V3f& point);

/// Around where rays leave the camera, at all times.
[[nodiscard]] Imath::Box3d bounds(const Camera& camera);
/// Where the ray of a meter begins, just off its surface, at a place of its film within [0, 1]^2.
[[nodiscard]] Imath::V3f meter_point(const Camera& meter, Imath::V2f place);

/// A ray of light that by itself runs into the camera's opening (see `CameraTraits`), as a connection: power
/// along it adds `weight` times that to the irradiance of the pixel at `film`. Nothing of one that misses the
/// opening, or whose image is beyond the film.
[[nodiscard]] std::optional<CameraConnection> connection_through(const Camera& camera, const Opening& opening,
                                                                 const Ray& light,
                                                                 const SampledSpectrum& wavelengths_nm);

/// Draws a point where light comes in by way of a ghost; nothing of a camera without any.
[[nodiscard]] std::optional<GhostEntrance> sample_ghost(const Camera& camera, Imath::V2f lens, float time);
/// The camera, seeing by way of the image alone.
[[nodiscard]] Camera without_ghosts(Camera camera);

/// The ray as it runs beside a camera that moves, seen from where that is at time 0.
[[nodiscard]] Ray seen_at_rest(const Camera& camera, const Ray& ray);
/// The direction in the world, at that time, of one that the camera has at time 0.
[[nodiscard]] Imath::V3d direction_at(const Camera& camera, const Imath::V3d& direction, float time);

/// The unit direction in the world, at that time, of what is the right of the picture; a meter has none. With
/// the way k of light that comes in, and it made perpendicular to k, k x right is up in the picture.
[[nodiscard]] std::optional<Imath::V3f> film_right(const Camera& camera, float time);

/// The weight [sr] of the ray from the middle of the lens to a film position, at 550 nm when the shutter
/// opens: what stands for a pixel's exposure by radiance where nothing is drawn.
[[nodiscard]] double central_weight(const Camera& camera, Imath::V2f film);

}  // namespace abbe
