#pragma once

#include <optional>
#include <vector>

#include "lens/beam.h"
#include "lens/spot.h"

namespace abbe::lens {

/// How fast a lens is on its axis, at one wavelength. Of displaced surfaces its beam is an ellipse: it counts
/// as the circle of the same area.
struct Speed {
  double entrance_diameter_mm;  ///< Of the real axial beam at the entrance pupil.
  double launch_diameter_mm;    ///< The same in the plane where `Beam` counts rays.
  double f_number;              ///< Focal length over the former; not a number where that is infinite.
  double working_f_number;      ///< 1/(2 n' sin U'): U' of the real marginal ray, sin^2 U' the area that the
                                ///< direction cosines of the beam along x and y fill, over pi.
  double transmittance;         ///< Mean over the axial beam.
  double t_stop;                ///< f-number over the root of the share of the power through the round stop
                                ///< that blades, clear apertures and the transmittance leave.
  double airy_radius_um;        ///< Of the first dark ring, 0.6098 lambda/(n' sin U'). [Born1999]
};
/// Nothing where the axial beam does not get to the image.
[[nodiscard]] std::optional<Speed> speed(const SystemAt& at, double stop_radius_mm, int side);

/// The way of a ray along the rim of the axial beam that does not get to the image, clear apertures obeyed;
/// nothing where the beam passes whole, to within `kNominalRounding` of the stop's radius.
[[nodiscard]] std::optional<RayPath> cut_rim_ray(const SystemAt& at, double stop_radius_mm);

/// The chief ray of a field in the plane of the image.
struct Chief {
  double height_mm;                  ///< y there.
  std::optional<double> distortion;  ///< Share by which it is off the paraxial height; none where that is 0,
                                     ///< and of directions of 90 degrees and more.
};
/// Where the image is off the paraxial focus the paraxial height is moved along the real chief ray.
[[nodiscard]] std::optional<Chief> chief_ray(const SystemAt& at, double field, double stop_radius_mm);

/// Irradiance of the image of an evenly bright object at a field, over that on the axis, apertures and losses
/// counted: the power P of the beam over the area of the image that its element of the object fills,
///
///   E(t)/E(0) = P(t)/P(0) sin t (dy/dt)^2_0/(y dy/dt),   E(h)/E(0) = P(h)/P(0) h (dy/dh)^2_0/(y dy/dh),
///
/// for directions t and heights h of objects, y the chief ray's height. Of systems with displaced surfaces,
/// and where a beam does not get to the image, none.
[[nodiscard]] std::optional<double> relative_illumination(const SystemAt& at, double field,
                                                          double stop_radius_mm, const Spot& there,
                                                          const Spot& on_axis);

/// Errors of rays along the tangential (y) and the sagittal (x) diameter of the stop, against the chief ray
/// of the primary wavelength [mm]; nothing where a ray does not get through.
struct RayFan {
  std::vector<double> pupil;  ///< In radii of the stop, from -1 to 1.
  std::vector<std::optional<double>> tangential;
  std::vector<std::optional<double>> sagittal;
};
[[nodiscard]] RayFan ray_fan(const Beam& beam, const Imath::V2d& chief_point, int count);

}  // namespace abbe::lens
