#pragma once

#include "lens/iris.h"
#include "scene/camera/frame.h"
#include "scene/camera/model.h"

namespace abbe {

/// The film behind an ideal lens: what lies in the plane in focus is sharp.
struct ThinLens {
  CameraFrame frame;
  double image_distance = 0;            ///< Lens to film [m].
  double focus_distance = 0;            ///< Lens to the plane in focus [m], perhaps infinite.
  double aperture_radius = 0;           ///< Of the opening [m].
  double transmittance = 1;             ///< Share of the light that the lens passes, at all wavelengths.
  std::optional<lens::Iris> iris = {};  ///< Blades that leave a polygon of the opening.

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

  /// Area of the opening, between its blades if it has some, over that of the circle.
  [[nodiscard]] double open_share() const { return iris ? iris->share() : 1; }
};
static_assert(CameraModel<ThinLens>);

}  // namespace abbe
