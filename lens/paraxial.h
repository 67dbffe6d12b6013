#pragma once

#include <vector>

#include "lens/system.h"

namespace abbe::lens {

/// A paraxial ray at a surface: its height there [mm], and its slope dy/dz behind it if not stated otherwise.
struct ParaxialHit {
  double y;
  double u;
};

/// Traces a paraxial ray of height y [mm] at the first vertex and slope u before it through all surfaces
/// [Welford1986]: n'u' = n u - y c (n' - n), y(next) = y + u' d. Here n and n' are the indices before and
/// behind a surface, c is its vertex curvature and d its thickness. Returns one hit per surface, without the
/// image. Ignores decentering and tilts.
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
  double entrance_magnification;  ///< Size of the entrance pupil over that of the stop, signed; infinite for
                                  ///< one at infinity.
  double stop_by_slope_mm;    ///< Height at the stop of a paraxial ray of slope 1 that meets the axis at the
                              ///< first vertex.
  double exit_magnification;  ///< Size of the exit pupil over that of the stop, signed; infinite for one at
                              ///< infinity.
  double image_distance_mm;   ///< Paraxial image of the object; the back focus for an object at infinity.
  double magnification;       ///< Lateral magnification of a near object; 0 for one at infinity.
};

/// Uses the vertex curvatures; ignores decentering and tilts.
[[nodiscard]] FirstOrder first_order(const SystemAt& at);

/// Projection of the stop from an image point into the tangent plane of the last vertex. A paraxial ray from
/// height y_s at the stop to height x at the image crosses it at y = magnification y_s + shift x.
struct StopImage {
  double magnification;
  double shift;  ///< 1 for an exit pupil at infinity.
};
/// Projection for an image plane `distance_mm` behind the last vertex. Not finite if that plane contains the
/// exit pupil.
[[nodiscard]] StopImage stop_image(const SystemAt& at, double distance_mm);

/// Paraxial chief ray of a field as defined in `System`: its height at the first vertex [mm] and its slope
/// dy/dz before that. NaN for directions of 90 degrees and more, and an infinite height for a direction to an
/// entrance pupil at infinity.
[[nodiscard]] ParaxialHit paraxial_chief_ray(const SystemAt& at, double field);

/// Height of the paraxial chief ray [mm] at a finite distance behind the last vertex. NaN for directions of
/// 90 degrees and more.
[[nodiscard]] double paraxial_chief_height(const SystemAt& at, double field, double distance_mm);

}  // namespace abbe::lens
