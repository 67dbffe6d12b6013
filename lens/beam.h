#pragma once

#include <optional>

#include <ImathBox.h>
#include <ImathVec.h>

#include "lens/trace.h"

namespace abbe::lens {

/// The rays from one point of the object at one wavelength, found by where they pass the stop.
///
/// Rays are counted by where they cross a plane before the lens: of an object at infinity the plane across
/// its direction through the middle of the paraxial entrance pupil, of a near one the tangent plane of the
/// first vertex. Equal areas of the former carry equal power.
class Beam {
 public:
  /// `field` as in `System`. Nothing when no ray gets through the middle of the stop. Clear apertures are
  /// ignored while rays are looked for. `at` must outlive the beam.
  [[nodiscard]] static std::optional<Beam> of(const SystemAt& at, double field, double stop_radius_mm);

  /// The ray through a point of the launch plane [mm].
  [[nodiscard]] Ray launch(const Imath::V2d& point) const;
  /// Where the ray must be launched that passes the stop at so many of its radii from its middle.
  [[nodiscard]] std::optional<Imath::V2d> aim(const Imath::V2d& pupil) const;
  [[nodiscard]] Imath::V2d chief() const { return chief_; }
  /// Where a ray passes the stop, in its radii; nothing when it does not get there.
  [[nodiscard]] std::optional<Imath::V2d> pupil_of(const Imath::V2d& launched) const;
  /// The rectangle of the launch plane that the stop fills.
  [[nodiscard]] Imath::Box2d bounds() const;
  /// Power that a source of radiance 1 sends from its point through an element of area of the launch plane:
  /// 1 for one at infinity; for a near one what a square millimetre there fills of its projected solid angle.
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
  double scale_;  // of the beam in the launch plane, paraxially
  Imath::V3d direction_{0, 0, 1};
  Imath::V3d object_{0, 0, 0};
  Imath::V2d chief_{0, 0};
};

/// Apertures that differ by no more than this share of them are the same: nominal f-numbers are rounded.
inline constexpr double kNominalRounding = 1e-3;

/// Radius of the stop [mm], as the aperture of the system says at the primary wavelength. Throws Error{scene}
/// when the ray that tells it does not get there.
[[nodiscard]] double stop_radius(const System& system);

}  // namespace abbe::lens
