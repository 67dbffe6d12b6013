#pragma once

#include <cmath>
#include <numbers>
#include <optional>

#include "scene/camera/frame.h"
#include "scene/camera/model.h"

namespace abbe {

/// Coordinates [m] along right and up: on the film as it is seen through the centre of the lens, upright, or
/// on the lens; or the tangent of a direction, per unit of depth.
using PlanePoint = Imath::V2d;

[[nodiscard]] inline PlanePoint film_plane(const FilmGrid& grid, Imath::V2f film) {
  return {(static_cast<double>(film.x) - grid.width * 0.5) * grid.pixel_pitch,
          (grid.height * 0.5 - static_cast<double>(film.y)) * grid.pixel_pitch};
}
/// The film position of a point of the plane; nothing beyond the film.
[[nodiscard]] std::optional<Imath::V2f> film_position(const FilmGrid& grid, const PlanePoint& point);

/// Cosine with the axis of the direction of that tangent.
[[nodiscard]] inline double cosine(const PlanePoint& tangent) {
  return 1 / std::sqrt(1 + tangent.dot(tangent));
}
/// Tangent of the angle to the axis of the direction from the lens centre to a corner of the film.
[[nodiscard]] double corner_tangent(const FilmGrid& grid, double image_distance);
/// A cosine computed as a double, lowered by the rounding of cosines stored as floats.
[[nodiscard]] inline double below_rounding(double cosine) {
  constexpr double kRounding = 1e-6;
  return cosine * (1 - kRounding);
}

/// What images a plane without distortion: the film behind an opening.
struct Perspective {
  const CameraFrame& frame;
  double image_distance;  ///< [m]
  double exposing_area;   ///< Of an opening without losses that exposes as much [m^2].
};
[[nodiscard]] inline double exposing_area(double aperture_radius, double transmittance) {
  return std::numbers::pi * aperture_radius * aperture_radius * transmittance;
}

/// Where a ray crosses the lens, in which direction of the scene, and its angles there and with the film.
struct LensCrossing {
  PlanePoint on_lens;
  PlanePoint tangent;
  double cos_theta;  ///< That of the tangent.
  double cos_film;
};

/// A film element dA sees through the lens element the solid angle dA cos^3/v^2 of the scene, v the image
/// distance; the lens element presents a share cos of its area. Hence the cos^4 law, with the angle on the
/// side of the scene.
[[nodiscard]] CameraRay ray_through(const Perspective& view, const LensCrossing& at, float time);

/// A point as a camera sees it: coordinates along right and up, from the centre of the lens, and its depth.
struct SeenPoint {
  PlanePoint across;
  double depth;
};
[[nodiscard]] SeenPoint seen_from(const CameraFrame& frame, const Imath::V3f& point);

/// Of a point at that depth, the lens point being drawn with `pdf_position`.
[[nodiscard]] CameraConnection connection_through(const Perspective& view, const FilmGrid& grid,
                                                  Imath::V2f film, const LensCrossing& at, double depth,
                                                  double pdf_position);

/// The tangent of a direction of the scene; nothing backwards.
[[nodiscard]] std::optional<PlanePoint> tangent_of(const CameraFrame& frame, const Imath::V3f& direction);

/// Of a ray there, its lens point being drawn with `pdf_position`: a pixel of area p^2 is seen with the
/// density v^2/(p^2 cos^3) of directions, and takes all flux that comes to it, over its area.
[[nodiscard]] CameraDensity density_through(const Perspective& view, const FilmGrid& grid, Imath::V2f film,
                                            const LensCrossing& at, double pdf_position);

}  // namespace abbe
