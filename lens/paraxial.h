#pragma once

#include <vector>

#include "lens/system.h"

namespace abbe::lens {

/// A paraxial ray at a surface: its height there and its slope behind it.
struct ParaxialHit {
  double y;
  double u;
};

/// Follows a paraxial ray of height y at the first vertex and slope u before it, to `surfaces` surfaces:
/// n'u' = n u - y c (n' - n), y(next) = y + u' d. Decentres and tilts are left out. [Welford1986]
[[nodiscard]] std::vector<ParaxialHit> paraxial_trace(const SystemAt& at, double y, double u);

/// What a system does to rays near its axis, at one wavelength. Distances of object space are counted from
/// the first vertex, of image space from the last, both positive towards +z, and infinite beyond `kMaxMm`.
struct FirstOrder {
  double focal_length_mm;         ///< f' = n'/power; infinite for a system without power.
  double back_focus_mm;           ///< Of the rear focal point.
  double front_focus_mm;          ///< Of the front focal point.
  double front_principal_mm;      ///< Of the principal plane of object space; infinite without power.
  double rear_principal_mm;       ///< Of the principal plane of image space; likewise.
  double entrance_pupil_mm;       ///< Of the image of the stop in object space.
  double exit_pupil_mm;           ///< Of the image of the stop in image space.
  double entrance_magnification;  ///< Entrance pupil over stop.
  double stop_by_slope_mm;        ///< Height at the stop of a ray of slope 1 through the first vertex.
  double exit_magnification;      ///< Exit pupil over stop.
  double image_distance_mm;       ///< Of the image of the object: the back focus for one at infinity.
  double magnification;           ///< Of a near object; 0 for one at infinity.
};

[[nodiscard]] FirstOrder first_order(const SystemAt& at);

/// How a point of the image, so far behind the last vertex, sees the stop through what is behind this: where
/// its paraxial rays pass the tangent plane of that vertex. Not finite in the plane of the exit pupil.
struct SeenStop {
  double magnification;  ///< Of the stop.
  double shift;          ///< How far its middle moves, over how far the point does: 1 of a pupil far away.
};
[[nodiscard]] SeenStop stop_seen_from(const SystemAt& at, double distance_mm);

/// Slope of a paraxial ray in a direction as in `System`; not a number from 90 degrees on.
[[nodiscard]] double paraxial_slope(double direction_deg);

/// The paraxial ray of a field, as in `System`, through the middle of the stop: its height at the first
/// vertex and its slope before that. Not a number for directions of 90 degrees and more.
struct ParaxialRay {
  double y;
  double u;
};
[[nodiscard]] ParaxialRay paraxial_chief_ray(const SystemAt& at, double field);

/// The height of that ray so far behind the last vertex.
[[nodiscard]] double paraxial_chief_height(const SystemAt& at, double field, double distance_mm);

}  // namespace abbe::lens
