#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include <ImathVec.h>

namespace abbe {

/// A ray in render coordinates [m], infinite or of length `t_max` [m], with a unit `direction`. `time` is the
/// time of the light along it, as a fraction of the exposure of the whole film: 0 when the shutter opens, 1
/// when it has closed for all rows; see `Shutter`.
template <typename T>
struct BasicRay {
  Imath::Vec3<T> origin;
  Imath::Vec3<T> direction;
  T t_max = std::numeric_limits<T>::infinity();
  float time = 0;
};
using Ray = BasicRay<float>;

/// An infinite ray from `origin` at that time of the exposure.
[[nodiscard]] inline Ray ray_at(const Imath::V3f& origin, const Imath::V3f& direction, float time) {
  return {origin, direction, std::numeric_limits<float>::infinity(), time};
}

/// A fixed unit direction that is unlikely to be parallel to a face of a scene. Rays along it count how often
/// they leave a shape.
template <typename T>
[[nodiscard]] Imath::Vec3<T> askew_direction() {
  return Imath::Vec3<T>(T(0.3618), T(0.5119), T(0.7791)).normalized();
}

/// A recorded ray.
struct LoggedRay {
  Ray ray;
  bool shadow;  ///< True for a shadow ray, false for a query of the nearest hit.
};

/// Rounds a point on a ray to float towards the ray's origin. The nearest floats might lie on the next
/// surface or behind it, where axis-parallel walls meet. Points that are floats up to double rounding are
/// unchanged. The code has no branches, because they would be unpredictable.
[[nodiscard]] inline Imath::V3f rounded_back(const Imath::V3d& point, const Imath::V3d& direction) {
  using Doubles [[gnu::vector_size(32)]] = double;
  using Floats [[gnu::vector_size(16)]] = float;
  using Integers [[gnu::vector_size(16)]] = std::int32_t;
  constexpr double kExact = 0x1p-44;
  const Doubles x{point.x, point.y, point.z, 0};
  const Doubles along{direction.x, direction.y, direction.z, 0};
  const auto nearest = __builtin_convertvector(x, Floats);
  const Doubles overshoot = __builtin_convertvector(nearest, Doubles) - x;
  const Doubles exact = kExact * (x < 0 ? -x : x);
  const auto overshoots = ((overshoot > exact) & (along > 0)) | ((overshoot < -exact) & (along < 0));
  const Integers outwards = (nearest > 0) == __builtin_convertvector(along > 0, Integers);
  const Integers steps = __builtin_convertvector(overshoots, Integers) & (nearest != 0) & (outwards | 1);
  const auto back = std::bit_cast<Floats>(std::bit_cast<Integers>(nearest) + steps);
  return {back[0], back[1], back[2]};
}

/// Largest absolute coordinate of a point, which determines the spacing of floats there.
[[nodiscard]] inline float largest_coordinate(const Imath::V3f& point) {
  return std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)});
}
/// Offset per unit of the largest coordinate of a point; it exceeds the rounding of the point.
inline constexpr float kOffsetSteps = 4 * std::numeric_limits<float>::epsilon();

/// Distance [m] from a surface at `point` at which rays that leave the surface start. Float rounding cannot
/// move such an origin to the surface.
[[nodiscard]] inline float offset_length(const Imath::V3f& point) {
  // Rounding puts a point on a surface off it by at most one float step along each axis, and the offset point
  // by half a step. Four steps of the largest coordinate exceed both; intersection in double resolves the
  // rest. Near the origin the steps vanish and this minimum applies. It is what double resolves from 0 on
  // planes a hundred metres wide, and at most a float step in a scene of one micrometre.
  constexpr float kMinOffset_m = 1e-13F;
  return std::max(kOffsetSteps * largest_coordinate(point), kMinOffset_m);
}

/// A surface point moved by a few float steps along the outward `normal`, to the side that `direction` points
/// to. A ray from there cannot hit the surface it leaves, whatever the scale of the scene. After
/// [Wachter2019], but in steps of the largest coordinate without a fixed length, because `Scene::intersect`
/// resolves sides exactly.
[[nodiscard]] inline Imath::V3f offset_point(const Imath::V3f& point, const Imath::V3f& normal,
                                             const Imath::V3f& direction) {
  return point + normal * std::copysign(offset_length(point), normal.dot(direction));
}

/// An infinite ray that leaves the surface at `point` in the unit `direction`, at that time of the exposure.
/// It starts at `offset_point`.
[[nodiscard]] inline Ray spawn(const Imath::V3f& point, const Imath::V3f& normal, const Imath::V3f& direction,
                               float time) {
  return ray_at(offset_point(point, normal, direction), direction, time);
}

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
