#pragma once

#include <cmath>
#include <limits>

#include <ImathVec.h>

namespace abbe {

/// Right-handed orthonormal axes (x cross y = z) with z along a unit vector. [Duff2017]
template <typename T>
struct Basis {
  Imath::Vec3<T> x, y, z;

  /// Axes with z = `n`, which has unit length; x and y are arbitrary but depend on `n` alone.
  explicit Basis(const Imath::Vec3<T>& n) : z(n) {
    const T sign = std::copysign(T(1), n.z);
    const T a = T(-1) / (sign + n.z);
    const T b = n.x * n.y * a;
    x = {T(1) + sign * n.x * n.x * a, sign * b, -sign * n.x};
    y = {b, sign + n.y * n.y * a, -n.y};
  }
  /// Axes with z = `n` and x along the component of `along`, of any length, perpendicular to `n`. Where that
  /// component vanishes, they are those of `n` alone.
  Basis(const Imath::Vec3<T>& n, const Imath::Vec3<T>& along) : Basis(n) {
    const Imath::Vec3<T> across = along - n * along.dot(n);
    if (!(across.length2() > std::numeric_limits<T>::epsilon() * along.length2())) return;
    x = across.normalized();
    y = n.cross(x);
  }
  /// Components of a vector along x, y and z.
  [[nodiscard]] Imath::Vec3<T> to_local(const Imath::Vec3<T>& v) const {
    return {v.dot(x), v.dot(y), v.dot(z)};
  }
  /// Vector with these components; inverse of `to_local`.
  [[nodiscard]] Imath::Vec3<T> to_world(const Imath::Vec3<T>& v) const { return x * v.x + y * v.y + z * v.z; }
};

/// Unit direction at azimuth `phi` [rad] around a unit `axis`, counted from x to y of `Basis(axis)`. `cap` is
/// 1 - cos of the angle between them, in [0, 2].
[[nodiscard]] inline Imath::V3f direction_about(const Imath::V3f& axis, float cap, float phi) {
  const float sin_theta = std::sqrt(cap * (2 - cap));
  return Basis<float>(axis).to_world({sin_theta * std::cos(phi), sin_theta * std::sin(phi), 1 - cap});
}

}  // namespace abbe
