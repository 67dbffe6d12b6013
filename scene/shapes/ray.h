#pragma once

#include <algorithm>
#include <cmath>
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

/// The point of a surface with outward `normal`, moved by a few representable floats to the side `direction`
/// leaves on, so that a ray from there cannot meet the surface it starts from, whatever the scale of the
/// scene. After [Wachter2019], but with steps of the largest coordinate and no fixed length, since
/// Scene::intersect is exact about sides.
[[nodiscard]] inline Imath::V3f offset_point(const Imath::V3f& point, const Imath::V3f& normal,
                                             const Imath::V3f& direction) {
  // A point on a surface is off it by rounding, at most half a float step along each axis; so is the point
  // moved. Four steps of the largest coordinate clear both, and intersection decides the rest in double. Near
  // the origin steps vanish, and the floor takes over: what double tells from 0 on planes a hundred metres
  // wide, and no more than a float step where all of a scene is a micrometre.
  constexpr float kOffsetSteps = 4 * std::numeric_limits<float>::epsilon();
  constexpr float kLeastOffset_m = 1e-13F;
  const float largest = std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)});
  const float distance = std::max(kOffsetSteps * largest, kLeastOffset_m);
  return point + normal * std::copysign(distance, normal.dot(direction));
}

/// A ray that starts there into `direction`, at that time of the exposure.
[[nodiscard]] inline Ray spawn(const Imath::V3f& point, const Imath::V3f& normal, const Imath::V3f& direction,
                               float time) {
  return ray_at(offset_point(point, normal, direction), direction, time);
}

}  // namespace abbe
