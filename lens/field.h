#pragma once

#include <optional>
#include <vector>

#include "lens/beam.h"
#include "lens/spot.h"

namespace abbe::lens {

/// Speed of a lens on its axis at one wavelength. With displaced surfaces, the elliptical beam counts as the
/// circle of equal area.
struct Speed {
  double entrance_diameter_mm;  ///< Diameter of the real axial beam at the entrance pupil.
  double launch_diameter_mm;    ///< Its diameter in the launch plane of `Beam`.
  double f_number;              ///< |Focal length| over `entrance_diameter_mm`; NaN if that is infinite.
  double working_f_number;  ///< 1/(2 n' sin U'), U' of the real marginal ray. pi sin^2 U' is the area of the
                            ///< direction cosines of the beam along x and y.
  double transmittance;     ///< Mean over the rays of the axial beam that arrive, in [0, 1].
  double t_stop;  ///< f-number / sqrt(T), T being the fraction of the power through the round stop that
                  ///< arrives at the image.
  double airy_radius_um;  ///< First dark ring, 0.6098 lambda/(n' sin U') [Born1999].
};
/// Speed of a lens from the rays through `side` x `side` cells of the axial beam (`spot`). Diameters and
/// f-numbers ignore clear apertures. Nothing if the axial beam does not arrive at the image.
[[nodiscard]] std::optional<Speed> speed(const SystemAt& at, double stop_radius_mm, int side);

/// Path of the first of four rim rays of the axial beam that does not arrive at the image. They are along +x,
/// +y, -x and -y in the stop, at its radius times 1 - `kNominalRounding`. Rays that cannot be aimed are
/// skipped. Nothing if all arrive, or if there is no axial beam.
[[nodiscard]] std::optional<RayPath> cut_rim_ray(const SystemAt& at, double stop_radius_mm);

/// Chief ray of a field in the image plane.
struct Chief {
  double height_mm;                  ///< y coordinate; clear apertures are ignored.
  std::optional<double> distortion;  ///< Relative deviation from the paraxial height; nothing if that is 0 or
                                     ///< undefined.
};
/// Traces the chief ray of a field, as defined in `System`. Nothing if it does not arrive at the image. The
/// paraxial height for `distortion` is that at the paraxial focus, moved to the image plane along the real
/// chief ray. If the defocus exceeds 0.1 of the focal length, the height in the image plane is used instead.
[[nodiscard]] std::optional<Chief> chief_ray(const SystemAt& at, double field, double stop_radius_mm);

/// Irradiance of the image of a uniform object at a field, relative to the axis, including apertures and
/// losses. It is the power P of the beam divided by the image area of the object element:
///
///   E(t)/E(0) = P(t)/P(0) sin t (dy/dt)^2_0/(y dy/dt)  for directions t,
///   E(h)/E(0) = P(h)/P(0) h (dy/dh)^2_0/(y dy/dh)      for heights h.
///
/// y is the height of the chief ray. `there` and `on_axis` are the spots of the field and of field 0, by the
/// same number of cells. Nothing for systems with displaced surfaces, and if a beam does not arrive at the
/// image.
[[nodiscard]] std::optional<double> relative_illumination(const SystemAt& at, double field,
                                                          double stop_radius_mm, const Spot& there,
                                                          const Spot& on_axis);

/// Transverse ray errors [mm] along the tangential (y) and sagittal (x) diameter of the stop, relative to the
/// chief ray of the primary wavelength. Nothing for rays that do not arrive.
struct RayFan {
  std::vector<double> pupil;  ///< Pupil coordinates in radii of the stop, from -1 to 1.
  std::vector<std::optional<double>> tangential;
  std::vector<std::optional<double>> sagittal;
};
/// Traces `count` evenly spaced rays along each diameter, with clear apertures. `chief_point` is (x, y) in
/// the image plane [mm].
[[nodiscard]] RayFan ray_fan(const Beam& beam, const Imath::V2d& chief_point, int count);

}  // namespace abbe::lens
