#pragma once

#include <numbers>
#include <optional>

#include "lens/doubles.h"
#include "scene/camera/lens_system.h"

// Where the lanes of a ray come to the film of a lens camera: what its rays and its connections share.
namespace abbe {

/// The axes of the lens in the scene: x to the right, y up, z with the light.
[[nodiscard]] Imath::V3d in_lens(const CameraFrame& frame, const Imath::V3d& v);
[[nodiscard]] Imath::V3d lens_in_scene(const CameraFrame& frame, const Imath::V3d& v);

/// The vector of a lane.
[[nodiscard]] inline Imath::V3d lane_of(const Imath::Vec3<lens::Doubles>& v, int lane) {
  return {v.x[lane], v.y[lane], v.z[lane]};
}

[[nodiscard]] inline double disc_area(double radius) {
  return std::numbers::pi * radius * radius;
}

/// The share of a camera's rays that goes by a route.
[[nodiscard]] double share_of(const LensSystem& camera, LensRoute route);

/// All lanes of a ray where they come to the film.
struct Landings {
  LaneImages images;
  SampledSpectrum transmittance;
  SampledSpectrum pdf;  ///< Of étendue, were each the hero, times the area of a pixel [1/sr].
};
/// Of light that comes along the ray against its direction, by that route. Nothing where no lane comes to the
/// film.
[[nodiscard]] std::optional<Landings> land(const LensSystem& camera, const FilmGrid& grid, const Ray& ray,
                                           const SampledSpectrum& wavelengths_nm, LensRoute route);

}  // namespace abbe
