#pragma once

#include <array>
#include <optional>

#include "lens/numbers.h"
#include "scene/camera/lens_system.h"

// Tracing of a ray's wavelengths from the scene to the film of a lens camera. Camera rays and connections use
// it.
namespace abbe {

/// Converts a vector, without a shift or a change of unit, from render coordinates to the axes of the lens: x
/// along `right`, y along `up`, z against `forward`, as light propagates.
[[nodiscard]] Imath::V3d to_lens(const CameraFrame& frame, const Imath::V3d& v);
/// Inverse of `to_lens`.
[[nodiscard]] Imath::V3d from_lens(const CameraFrame& frame, const Imath::V3d& v);

/// Probability with which a camera ray takes a route through the lens; 1 if the camera has no ghosts.
[[nodiscard]] double route_probability(const LensSystem& camera, LensRoute route);

/// The film positions of all wavelengths of a ray.
struct FilmHits {
  WavelengthImages images;
  SampledSpectrum transmittance;  ///< Of the lens, in [0, 1]; 0 for wavelengths that do not arrive.
  /// Density in étendue that each wavelength as the hero would have, times the area of a pixel [1/sr]. It
  /// includes `route_probability`; 0 for wavelengths that do not arrive.
  SampledSpectrum pdf;
};
/// A ray from the lens into the scene, in render coordinates, and the wavelengths along it.
struct SceneRay {
  Ray ray;
  SampledSpectrum wavelengths_nm;
};
/// Traces light along two rays, against their directions, by one route to the film. Nothing for a ray of
/// which no wavelength arrives on the film at a place and angle that `sample_ray` can sample.
[[nodiscard]] std::array<std::optional<FilmHits>, 2> trace_pair_to_film(const LensSystem& camera,
                                                                        const FilmGrid& grid,
                                                                        const std::array<SceneRay, 2>& rays,
                                                                        LensRoute route);
/// Traces one ray, as `trace_pair_to_film` does.
[[nodiscard]] inline std::optional<FilmHits> trace_to_film(const LensSystem& camera, const FilmGrid& grid,
                                                           const SceneRay& ray, LensRoute route) {
  return trace_pair_to_film(camera, grid, {ray, ray}, route)[0];
}

}  // namespace abbe
