#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include <ImathVec.h>

namespace abbe {

/// A half line, or its first `t_max`; lengths in metres, `direction` of unit length. Light runs along it at
/// `time`, the share of the exposure of the whole film that has gone by: 0 when the shutter opens, 1 when it
/// has closed for all rows; see `Shutter`.
template <typename T>
struct BasicRay {
  Imath::Vec3<T> origin;
  Imath::Vec3<T> direction;
  T t_max = std::numeric_limits<T>::infinity();
  float time = 0;
};
using Ray = BasicRay<float>;

/// The half line from `origin`, at that time of the exposure.
[[nodiscard]] inline Ray ray_at(const Imath::V3f& origin, const Imath::V3f& direction, float time) {
  return {origin, direction, std::numeric_limits<float>::infinity(), time};
}

/// A direction that no face of a scene is likely to lie along: where a ray is to tell how often it leaves a
/// shape.
template <typename T>
[[nodiscard]] Imath::Vec3<T> askew_direction() {
  return Imath::Vec3<T>(T(0.3618), T(0.5119), T(0.7791)).normalized();
}

/// A ray as it was asked of a scene: for its nearest hit, or whether anything blocks it.
struct LoggedRay {
  Ray ray;
  bool shadow;
};

/// Where a ray of that direction has come to, its coordinates rounded to the side that it has come from: to
/// the nearest floats, it may lie on what the ray would have met next, or beyond, where walls along the axes
/// meet. One that is a float but for what is left of double stays what it is. Without a branch, as none can
/// tell to which side the next one will be rounded.
[[nodiscard]] inline Imath::V3f rounded_back(const Imath::V3d& point, const Imath::V3d& direction) {
  using Doubles [[gnu::vector_size(32)]] = double;
  using Floats [[gnu::vector_size(16)]] = float;
  using Integers [[gnu::vector_size(16)]] = std::int32_t;
  constexpr double kExact = 0x1p-44;
  const Doubles x{point.x, point.y, point.z, 0};
  const Doubles along{direction.x, direction.y, direction.z, 0};
  const auto nearest = __builtin_convertvector(x, Floats);
  const Doubles past = __builtin_convertvector(nearest, Doubles) - x;
  const Doubles exact = kExact * (x < 0 ? -x : x);
  const auto beyond = ((past > exact) & (along > 0)) | ((past < -exact) & (along < 0));
  const Integers outwards = (nearest > 0) == __builtin_convertvector(along > 0, Integers);
  const Integers steps = __builtin_convertvector(beyond, Integers) & (nearest != 0) & (outwards | 1);
  const auto back = std::bit_cast<Floats>(std::bit_cast<Integers>(nearest) + steps);
  return {back[0], back[1], back[2]};
}

/// The largest of the coordinates of a point, which says how far apart floats are there.
[[nodiscard]] inline float largest_coordinate(const Imath::V3f& point) {
  return std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)});
}
/// Some steps of floats for each unit of the largest coordinate: what clears a point of its own rounding.
inline constexpr float kOffsetSteps = 4 * std::numeric_limits<float>::epsilon();

/// How far [m] off a surface at `point` is what does not lie on it, for all that floats tell: what a ray that
/// leaves the surface there starts at.
[[nodiscard]] inline float offset_length(const Imath::V3f& point) {
  // A point on a surface is off it by rounding, at most a float step along each axis, and the point moved by
  // half a step. Four steps of the largest coordinate clear both, and intersection decides the rest in
  // double. Near the origin steps vanish, and the floor takes over: what double tells from 0 on planes a
  // hundred metres wide, and no more than a float step where all of a scene is a micrometre.
  constexpr float kLeastOffset_m = 1e-13F;
  return std::max(kOffsetSteps * largest_coordinate(point), kLeastOffset_m);
}

/// The point of a surface with outward `normal`, moved by a few representable floats to the side `direction`
/// leaves on, so that a ray from there cannot meet the surface it starts from, whatever the scale of the
/// scene. After [Wachter2019], but with steps of the largest coordinate and no fixed length, since
/// Scene::intersect is exact about sides.
[[nodiscard]] inline Imath::V3f offset_point(const Imath::V3f& point, const Imath::V3f& normal,
                                             const Imath::V3f& direction) {
  return point + normal * std::copysign(offset_length(point), normal.dot(direction));
}

/// A ray that starts there into `direction`, at that time of the exposure.
[[nodiscard]] inline Ray spawn(const Imath::V3f& point, const Imath::V3f& normal, const Imath::V3f& direction,
                               float time) {
  return ray_at(offset_point(point, normal, direction), direction, time);
}

}  // namespace abbe
