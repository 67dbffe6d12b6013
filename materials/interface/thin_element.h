#pragma once

#include <cmath>

#include <ImathVec.h>

#include "materials/interface/mueller.h"

namespace abbe {

/// What a linear polariser does about its axis, `blocked` being its transmittance across it over that along
/// it.
template <typename T>
[[nodiscard]] MuellerElements<T> polariser_mueller(const T& blocked) {
  using std::sqrt;
  return mueller_elements(T(1), blocked, Complex<T>{sqrt(blocked), T(0)});
}

/// What a wave plate of that retardance [rad] does about its fast axis: fields across it lag behind, so that
/// their phase is the greater one.
template <typename T>
[[nodiscard]] MuellerElements<T> wave_plate_mueller(const T& retardance) {
  using std::cos;
  using std::sin;
  return {T(0), T(1), cos(retardance), -sin(retardance)};
}

/// What of an axis in the plane z = 0 is across the unit vector w, as a unit vector; any across it where
/// nothing is left.
template <typename T>
[[nodiscard]] Imath::Vec3<T> projected_axis(const Imath::Vec2<T>& axis, const Imath::Vec3<T>& w) {
  const Imath::Vec3<T> projected = w.cross(Imath::Vec3<T>(axis.x, axis.y, 0)).cross(w);
  const T length = projected.length();
  return length > T(0) ? projected / length : across(w, w);
}

}  // namespace abbe
