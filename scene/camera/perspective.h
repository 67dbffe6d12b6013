#pragma once

#include <optional>

#include "lens/iris.h"
#include "scene/camera/model.h"

namespace abbe {

/// Point [m] of the upright film plane for a film position [pixels]: along the picture's right and up from
/// the film's center, as seen through the center of the lens.
[[nodiscard]] inline Imath::V2d film_plane(const FilmGrid& grid, Imath::V2f film) {
  return {(static_cast<double>(film.x) - grid.width * 0.5) * grid.pixel_pitch,
          (grid.height * 0.5 - static_cast<double>(film.y)) * grid.pixel_pitch};
}
/// Inverse of `film_plane`: film position [pixels], in [0, width) x [0, height); nothing outside the film.
[[nodiscard]] std::optional<Imath::V2f> film_position(const FilmGrid& grid, const Imath::V2d& point);

/// A pinhole camera, in which everything is in focus. Its exposure is that of an opening of the nominal size.
/// The functions are those of `CameraModel`; random numbers for the lens have no effect.
struct Pinhole {
  CameraFrame frame;
  double image_distance = 0;   ///< From opening to film [m]; must be positive.
  double aperture_radius = 0;  ///< Radius of the nominal opening [m]; must be positive.
  double transmittance = 1;    ///< Fraction of the light that is transmitted, at all wavelengths.

  [[nodiscard]] CameraRay sample_ray(const FilmGrid& grid, const CameraSample& sample) const;
  [[nodiscard]] std::optional<CameraConnection> sample_towards(const FilmGrid& grid, const Imath::V3f& point,
                                                               const CameraSample& sample) const;
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

/// A camera with an ideal thin lens, which images the plane in focus sharply. Functions without a comment are
/// those of `CameraModel`.
struct ThinLens {
  CameraFrame frame;
  double image_distance = 0;   ///< From lens to film [m]; must be positive.
  double focus_distance = 0;   ///< From lens to the plane in focus [m]; positive, may be infinite.
  double aperture_radius = 0;  ///< Radius of the opening [m], of the circle around the blades; positive.
  double transmittance = 1;    ///< Fraction of the light that the lens transmits, at all wavelengths.
  std::optional<lens::Iris> iris = {};  ///< Blades that reduce the opening to a polygon.

  [[nodiscard]] CameraRay sample_ray(const FilmGrid& grid, const CameraSample& sample) const;
  [[nodiscard]] std::optional<CameraConnection> sample_towards(const FilmGrid& grid, const Imath::V3f& point,
                                                               const CameraSample& sample) const;
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
