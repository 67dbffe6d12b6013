#pragma once

#include <cmath>
#include <numbers>
#include <optional>

#include "lens/iris.h"
#include "scene/camera/model.h"

namespace abbe {

/// Coordinates [m] along right and up: on the film as seen through the center of the lens, upright, or on the
/// lens. For a direction they are its tangents, per unit of depth.
using PlanePoint = Imath::V2d;

/// Point of the upright film plane [m], relative to the film's center, for a film position [pixels].
[[nodiscard]] inline PlanePoint film_plane(const FilmGrid& grid, Imath::V2f film) {
  return {(static_cast<double>(film.x) - grid.width * 0.5) * grid.pixel_pitch,
          (grid.height * 0.5 - static_cast<double>(film.y)) * grid.pixel_pitch};
}
/// Inverse of `film_plane`: film position [pixels], in [0, width) x [0, height); nothing outside the film.
[[nodiscard]] std::optional<Imath::V2f> film_position(const FilmGrid& grid, const PlanePoint& point);

/// Cosine between the axis and the direction with that tangent.
[[nodiscard]] inline double cosine(const PlanePoint& tangent) {
  return 1 / std::sqrt(1 + tangent.dot(tangent));
}
/// Tangent of the angle between the axis and the direction from the lens center to a corner of the film, at
/// the image distance [m].
[[nodiscard]] double corner_tangent(const FilmGrid& grid, double image_distance);
/// Lowers a cosine computed in double by the rounding of cosines stored as floats.
[[nodiscard]] inline double below_rounding(double cosine) {
  constexpr double kRounding = 1e-6;
  return cosine * (1 - kRounding);
}

/// Imaging of a plane without distortion, onto a film behind an opening.
struct Perspective {
  const CameraFrame& frame;  ///< Must outlive this.
  double image_distance;     ///< [m]
  double exposing_area;      ///< Area of the lossless opening that gives the same exposure [m^2].
};
/// Exposing area [m^2] of a round opening of that radius [m] and that transmittance in [0, 1].
[[nodiscard]] inline double exposing_area(double aperture_radius, double transmittance) {
  return std::numbers::pi * aperture_radius * aperture_radius * transmittance;
}

/// The intersection of a ray with the lens, its direction in the scene, and its angles with the axis and at
/// the film.
struct LensCrossing {
  PlanePoint on_lens;
  PlanePoint tangent;  ///< Direction into the scene.
  double cos_theta;    ///< Cosine between the axis and that direction.
  double cos_film;     ///< Cosine of the angle of incidence on the film.
};

/// The camera ray through a point of the lens, with the weight exposing_area cos^4/v^2 [sr]. A film element
/// dA sees through a lens element the solid angle dA cos^3/v^2 of the scene, v being the image distance. The
/// lens element's projected area is proportional to cos. This gives the cos^4 law, with the angle on the
/// scene side.
[[nodiscard]] CameraRay ray_through(const Perspective& view, const LensCrossing& at, float time);

/// A point in camera coordinates [m]: along right and up from the lens center, and its depth along `forward`,
/// negative behind the camera.
struct CameraPoint {
  PlanePoint across;
  double depth;
};
[[nodiscard]] CameraPoint to_camera_space(const CameraFrame& frame, const Imath::V3f& point);

/// The connection of a point at that depth [m], > 0, to the film position `film`, if the lens point has the
/// density `pdf_position` [1/m^2], or 1 for a single point. The weight is exposing_area cos/(d^2 p^2), where
/// d is the distance and p the pixel pitch.
[[nodiscard]] CameraConnection connection_through(const Perspective& view, const FilmGrid& grid,
                                                  Imath::V2f film, const LensCrossing& at, double depth,
                                                  double pdf_position);

/// The tangent of a scene direction; nothing for directions perpendicular to the axis or backward.
[[nodiscard]] std::optional<PlanePoint> tangent_of(const CameraFrame& frame, const Imath::V3f& direction);

/// The density of a ray, if its lens point has the density `pdf_position` [1/m^2], or 1 for a single point. A
/// pixel of area p^2 has the density v^2/(p^2 cos^3) in directions. It receives the whole flux along the ray,
/// divided by its area.
[[nodiscard]] CameraDensity density_through(const Perspective& view, const FilmGrid& grid, Imath::V2f film,
                                            const LensCrossing& at, double pdf_position);

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
