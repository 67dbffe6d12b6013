#include "materials/interface/mueller.h"

#include <cmath>

namespace abbe {

Imath::V3d across(const Imath::V3d& a, const Imath::V3d& b) {
  const Imath::V3d normal = a.cross(b);
  const double length = normal.length();
  if (length > 0) return normal / length;
  return (std::abs(a.x) < std::abs(a.y) ? Imath::V3d(0, a.z, -a.y) : Imath::V3d(a.z, 0, -a.x)).normalized();
}

}  // namespace abbe
