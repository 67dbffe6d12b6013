#pragma once

#include "scene/camera/frame.h"
#include "scene/camera/model.h"

namespace abbe {

/// The film behind a point, which sees everything sharp. It exposes as an opening of its nominal size would.
struct Pinhole {
  CameraFrame frame;
  double image_distance = 0;   ///< Opening to film [m].
  double aperture_radius = 0;  ///< Of the nominal opening [m].
  double transmittance = 1;    ///< Share of the light that passes, at all wavelengths.

  [[nodiscard]] CameraRay sample_ray(const FilmGrid& grid, Imath::V2f film, Imath::V2f lens,
                                     const SampledSpectrum& wavelengths_nm, int hero, float time) const;
  [[nodiscard]] std::optional<CameraConnection> sample_towards(const FilmGrid& grid, const Imath::V3f& point,
                                                               Imath::V2f lens,
                                                               const SampledSpectrum& wavelengths_nm,
                                                               float time) const;
  [[nodiscard]] std::optional<CameraDensity> density(const FilmGrid& grid, const Ray& ray,
                                                     const SampledSpectrum& wavelengths_nm,
                                                     LensRoute route) const;
  [[nodiscard]] double least_film_cosine(const FilmGrid& grid) const;
  [[nodiscard]] CameraTraits traits() const;
  [[nodiscard]] const Imath::V3d& position() const { return frame.position; }
  [[nodiscard]] Imath::V3d middle() const { return frame.position; }
  void translate(const Imath::V3d& by) { frame.position += by; }
};
static_assert(CameraModel<Pinhole>);

}  // namespace abbe
