#pragma once

#include <cmath>

#include <ImathVec.h>

namespace abbe::test {

/// Solid angle of a triangle. [VanOosterom1983]
inline double solid_angle(const Imath::V3d& a, const Imath::V3d& b, const Imath::V3d& c) {
  const double la = a.length();
  const double lb = b.length();
  const double lc = c.length();
  return 2 * std::atan2(std::abs(a.dot(b.cross(c))),
                        la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

}  // namespace abbe::test
