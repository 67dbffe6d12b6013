#pragma once

#include <vector>

#include "lens/system.h"

namespace abbe::lens {

/// A paraxial ray at a surface: its height there and its slope behind it.
struct ParaxialHit {
  double y;
  double u;
};

/// Traces a paraxial ray of height y at the first vertex and slope u before it through all surfaces
/// [Welford1986]: n'u' = n u - y c (n' - n), y(next) = y + u' d. Ignores decentering and tilts.
[[nodiscard]] std::vector<ParaxialHit> paraxial_trace(const SystemAt& at, double y, double u);

/// First-order properties of a system at one wavelength. Distances in object space are measured from the
/// first vertex, those in image space from the last. They are positive towards +z, and infinite above
/// `kMaxMm`.
struct FirstOrder {
  double focal_length_mm;         ///< f' = n'/power; infinite for a system without power.
  double back_focus_mm;           ///< Rear focal point.
  double front_focus_mm;          ///< Front focal point.
  double front_principal_mm;      ///< Principal plane of object space; infinite without power.
  double rear_principal_mm;       ///< Principal plane of image space; infinite without power.
  double entrance_pupil_mm;       ///< Image of the stop in object space.
  double exit_pupil_mm;           ///< Image of the stop in image space.
  double entrance_magnification;  ///< Size of the entrance pupil over that of the stop, signed.
  double stop_by_slope_mm;        ///< Height at the stop of a ray of slope 1 through the first vertex.
  double exit_magnification;      ///< Size of the exit pupil over that of the stop, signed.
  double image_distance_mm;       ///< Image of the object; the back focus for an object at infinity.
  double magnification;           ///< Lateral magnification of a near object; 0 for one at infinity.
};

[[nodiscard]] FirstOrder first_order(const SystemAt& at);

/// Projection of the stop, through the surfaces behind it, from a point of the image onto the tangent plane
/// of the last vertex, in paraxial optics. The image is `distance_mm` behind that vertex. Not finite if the
/// image is in the exit pupil.
struct StopImage {
  double magnification;  ///< Magnification of the stop.
  double shift;          ///< Movement of its center over that of the image point; 1 for a distant pupil.
};
[[nodiscard]] StopImage stop_image(const SystemAt& at, double distance_mm);

/// Slope of a paraxial ray in a direction as defined in `System`; NaN for 90 degrees and more.
[[nodiscard]] double paraxial_slope(double direction_deg);

/// Paraxial chief ray of a field as defined in `System`: its height at the first vertex and its slope before
/// that. NaN for directions of 90 degrees and more.
struct ParaxialRay {
  double y;
  double u;
};
[[nodiscard]] ParaxialRay paraxial_chief_ray(const SystemAt& at, double field);

/// Height of the paraxial chief ray at a distance behind the last vertex.
[[nodiscard]] double paraxial_chief_height(const SystemAt& at, double field, double distance_mm);

}  // namespace abbe::lens
