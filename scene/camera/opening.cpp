#include <cmath>

#include "scene/camera/model.h"

namespace abbe {

std::optional<double> Opening::crossed_by(const Ray& ray) const {
  const Imath::V3d along(ray.direction);
  const double inward = -along.dot(normal);
  if (!(inward > 0)) return std::nullopt;
  const Imath::V3d from = Imath::V3d(ray.origin) - center;
  const double t = from.dot(normal) / inward;
  if (!(t > 0)) return std::nullopt;
  const Imath::V3d across = u.cross(v);
  const Imath::V3d point = from + along * t;
  const double a = point.cross(v).dot(across) / across.length2();
  const double b = u.cross(point).dot(across) / across.length2();
  const bool within = round ? a * a + b * b <= 1 : std::abs(a) <= 1 && std::abs(b) <= 1;
  const bool passes = within && (!iris || iris->contains({a, b}));
  return passes ? std::optional(t) : std::nullopt;
}

}  // namespace abbe
