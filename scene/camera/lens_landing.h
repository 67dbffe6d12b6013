#pragma once

#include <array>
#include <optional>

#include "lens/numbers.h"
#include "scene/camera/lens_system.h"

// Where the lanes of a ray come to the film of a lens camera: what its rays and its connections share.
namespace abbe {

/// The axes of the lens in the scene: x to the right, y up, z with the light.
[[nodiscard]] Imath::V3d in_lens(const CameraFrame& frame, const Imath::V3d& v);
[[nodiscard]] Imath::V3d lens_in_scene(const CameraFrame& frame, const Imath::V3d& v);

/// The share of a camera's rays that goes by a route.
[[nodiscard]] double share_of(const LensSystem& camera, LensRoute route);

/// All lanes of a ray where they come to the film.
struct Landings {
  LaneImages images;
  SampledSpectrum transmittance;
  SampledSpectrum pdf;  ///< Of étendue, were each the hero, times the area of a pixel [1/sr].
};
/// A ray of the scene, and the lanes along it.
struct LandingRay {
  Ray ray;
  SampledSpectrum wavelengths_nm;
};
/// Of light that comes along two rays against their directions, by that route. Nothing where no lane comes to
/// the film.
[[nodiscard]] std::array<std::optional<Landings>, 2> land_two(const LensSystem& camera, const FilmGrid& grid,
                                                              const std::array<LandingRay, 2>& rays,
                                                              LensRoute route);
/// Of one ray.
[[nodiscard]] inline std::optional<Landings> land(const LensSystem& camera, const FilmGrid& grid,
                                                  const LandingRay& ray, LensRoute route) {
  return land_two(camera, grid, {ray, ray}, route)[0];
}

}  // namespace abbe
