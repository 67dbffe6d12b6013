#pragma once

#include "lens/iris.h"
#include "scene/camera/frame.h"
#include "scene/camera/model.h"

namespace abbe {

/// A camera with an ideal thin lens, which images the plane in focus sharply. Functions without a comment are
/// those of `CameraModel`.
struct ThinLens {
  CameraFrame frame;
  double image_distance = 0;   ///< From lens to film [m]; must be positive.
  double focus_distance = 0;   ///< From lens to the plane in focus [m]; positive, may be infinite.
  double aperture_radius = 0;  ///< Radius of the opening [m], of the circle around the blades; positive.
  double transmittance = 1;    ///< Fraction of the light that the lens transmits, at all wavelengths.
  std::optional<lens::Iris> iris = {};  ///< Blades that reduce the opening to a polygon.

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

  /// Area of the opening between its blades, relative to the full circle: in (0, 1].
  [[nodiscard]] double open_fraction() const { return iris ? iris->area_fraction() : 1; }
};
static_assert(CameraModel<ThinLens>);

}  // namespace abbe
