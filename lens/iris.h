#pragma once

#include <ImathVec.h>

namespace abbe::lens {

/// Allowed numbers of blades, both included.
inline constexpr int kMinBlades = 3;
inline constexpr int kMaxBlades = 32;

/// Opening of a stop with straight blades: the regular polygon inscribed in its circle, with one corner per
/// blade. Points are in radii of the circle from its center, x to the right for a viewer who looks out of the
/// camera, y up. These are the x and y of the lens.
class Iris {
 public:
  /// `blades` in [`kMinBlades`, `kMaxBlades`]. One corner points up, rotated by `rotation_deg` clockwise in
  /// the viewing direction of the camera. The caller checks the number.
  Iris(int blades, double rotation_deg);

  /// True if light passes at the point, edges included.
  [[nodiscard]] bool contains(const Imath::V2d& point) const;
  /// Area of the polygon over that of the circle: N/(2 pi) sin(2 pi/N) for N blades.
  [[nodiscard]] double area_fraction() const;
  /// Maps a point of the unit disc to the polygon, continuously and with equal areas. The center maps to the
  /// center.
  [[nodiscard]] Imath::V2d point(const Imath::V2d& disc) const;

 private:
  /// Polar coordinates of a point relative to the nearest blade.
  struct BladeCoordinates {
    double radius;
    /// Angle from the center of the blade's edge, clockwise, at most `half_angle_` in magnitude.
    double angle;
    double blade_angle;  ///< Direction of that center, clockwise from up.
  };
  [[nodiscard]] BladeCoordinates blade_coordinates(const Imath::V2d& point) const;

  double rotation_;
  double half_angle_;  ///< Half of the angle of an edge at the center.
};

}  // namespace abbe::lens
