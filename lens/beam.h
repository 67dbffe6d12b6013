#pragma once

#include <optional>

#include <ImathBox.h>
#include <ImathVec.h>

#include "lens/trace.h"

namespace abbe::lens {

/// The rays from one object point at one wavelength, in the coordinates of `system.h` [mm]; no function
/// throws. A ray is given by its point in a launch plane in front of the lens. For an object at infinity,
/// this is the plane normal to its direction through the center of the paraxial entrance pupil. Its axes are
/// x and the direction normal to x and to the rays. For a near object, it is the tangent plane of the first
/// vertex.
class Beam {
 public:
  /// Beam of `field` as defined in `System`, ignoring clear apertures. Nothing if no ray passes through the
  /// center of the stop. `stop_radius_mm` > 0 is the unit of positions at the stop. `at` must outlive the
  /// beam.
  [[nodiscard]] static std::optional<Beam> of(const SystemAt& at, double field, double stop_radius_mm);

  /// Ray through a point of the launch plane [mm], on which it starts, towards +z.
  [[nodiscard]] Ray launch(const Imath::V2d& point) const;
  /// Point of the launch plane [mm] whose ray passes the stop at `pupil` (in radii of the stop); nothing if
  /// there is none.
  [[nodiscard]] std::optional<Imath::V2d> aim(const Imath::V2d& pupil) const;
  /// Point of the launch plane [mm] whose ray passes the center of the stop.
  [[nodiscard]] Imath::V2d chief() const { return chief_; }
  /// Position at the stop, in radii of the stop, of the ray through a point of the launch plane [mm]. Nothing
  /// if it misses a surface on the way or is totally reflected.
  [[nodiscard]] std::optional<Imath::V2d> pupil_of(const Imath::V2d& launched) const;
  /// Bounding rectangle of the rays through the stop in the launch plane [mm], with a margin of 1 %.
  [[nodiscard]] Imath::Box2d bounds() const;
  /// Power per area of the launch plane, relative for an object at infinity, where it is 1. For a near object
  /// it is the solid angle per area [sr/mm^2], projected onto the object plane.
  [[nodiscard]] double density(const Imath::V2d& launched) const;
  [[nodiscard]] const SystemAt& at() const { return *at_; }

 private:
  Beam(const SystemAt& at, double stop_radius_mm);
  void set_field(double field);
  [[nodiscard]] bool solve(const Imath::V2d& pupil, Imath::V2d& launched) const;
  bool find_chief(double field);

  const SystemAt* at_;
  double radius_;
  double pupil_z_;
  double scale_;  // paraxial radius of the beam in the launch plane
  Imath::V3d direction_{0, 0, 1};
  Imath::V3d object_{0, 0, 0};
  Imath::V2d chief_{0, 0};
};

/// Relative difference below which apertures count as equal, because nominal f-numbers are rounded.
inline constexpr double kNominalRounding = 1e-3;

/// Radius of the stop [mm] that gives the aperture of the system at the primary wavelength, without
/// decentering and tilts. Throws Error{scene} if the ray that determines it does not arrive at the stop.
[[nodiscard]] double stop_radius(const System& system);

}  // namespace abbe::lens
