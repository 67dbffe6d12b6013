#pragma once

#include "scene/camera/frame.h"
#include "scene/camera/model.h"

namespace abbe {

/// A pinhole camera, in which everything is in focus. Its exposure is that of an opening of the nominal size.
/// The functions are those of `CameraModel`; random numbers for the lens have no effect.
struct Pinhole {
  CameraFrame frame;
  double image_distance = 0;   ///< From opening to film [m]; must be positive.
  double aperture_radius = 0;  ///< Radius of the nominal opening [m]; must be positive.
  double transmittance = 1;    ///< Fraction of the light that is transmitted, at all wavelengths.

  [[nodiscard]] CameraRay sample_ray(const FilmGrid& grid, Imath::V2f film, Imath::V2f lens,
                                     const SampledSpectrum& wavelengths_nm, int hero, float time) const;
  [[nodiscard]] std::optional<CameraConnection> sample_towards(const FilmGrid& grid, const Imath::V3f& point,
                                                               Imath::V2f lens,
                                                               const SampledSpectrum& wavelengths_nm,
                                                               float time) const;
  [[nodiscard]] std::optional<CameraDensity> density(const FilmGrid& grid, const Ray& ray,
                                                     const SampledSpectrum& wavelengths_nm,
                                                     LensRoute route) const;
  [[nodiscard]] double min_film_cosine(const FilmGrid& grid) const;
  [[nodiscard]] CameraTraits traits() const;
  [[nodiscard]] const Imath::V3d& position() const { return frame.position; }
  [[nodiscard]] Imath::V3d center() const { return frame.position; }
  void translate(const Imath::V3d& by) { frame.position += by; }
};
static_assert(CameraModel<Pinhole>);

}  // namespace abbe
