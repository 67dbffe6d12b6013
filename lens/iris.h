#pragma once

#include <ImathVec.h>

namespace abbe::lens {

inline constexpr int kLeastBlades = 3;
inline constexpr int kMostBlades = 32;

/// What straight blades leave of the round opening of a stop: the regular polygon inscribed in its circle,
/// with a corner for each blade. Points are in radii of the circle from its middle, x to the right of who
/// looks out of the camera and y up.
class Iris {
 public:
  /// `blades` in [`kLeastBlades`, `kMostBlades`]. A corner is up, or turned from there by `rotation_deg`
  /// clockwise, as the camera looks.
  Iris(int blades, double rotation_deg);

  /// Whether light passes there.
  [[nodiscard]] bool contains(const Imath::V2d& point) const;
  /// Area of the polygon over that of the circle, N/(2 pi) sin(2 pi/N) of N blades.
  [[nodiscard]] double share() const;
  /// The point of the polygon that one of the unit disc stands for. Equal areas stand for equal ones, the
  /// middle for the middle, and what is near stays near.
  [[nodiscard]] Imath::V2d point(const Imath::V2d& disc) const;

 private:
  /// A point by the blade that is next to it.
  struct Beside {
    double radius;
    double angle;        ///< From the middle of the blade's edge, clockwise, no more than `half_angle_`.
    double blade_angle;  ///< From up, clockwise, of that middle.
  };
  [[nodiscard]] Beside beside_blade(const Imath::V2d& point) const;

  double rotation_;
  double half_angle_;  ///< Of an edge, seen from the middle.
};

}  // namespace abbe::lens
