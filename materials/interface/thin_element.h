#pragma once

#include <cmath>

#include <ImathVec.h>

#include "materials/interface/mueller.h"

namespace abbe {

/// Mueller elements of a linear polariser about its axis. `blocked` is the transmittance perpendicular to the
/// axis divided by that along it, in [0, 1].
template <typename T>
[[nodiscard]] MuellerElements<T> polariser_mueller(const T& blocked) {
  using std::sqrt;
  return mueller_elements(T(1), blocked, Complex<T>{sqrt(blocked), T(0)});
}

/// Mueller elements of a wave plate with a retardance [rad] about its fast axis. Fields perpendicular to the
/// fast axis are retarded, so their phase is larger.
template <typename T>
[[nodiscard]] MuellerElements<T> wave_plate_mueller(const T& retardance) {
  using std::cos;
  using std::sin;
  return {T(0), T(1), cos(retardance), -sin(retardance)};
}

/// Unit vector along the component of an axis in the plane z = 0 that is perpendicular to the unit vector w.
/// If that component is zero, any unit vector perpendicular to w.
template <typename T>
[[nodiscard]] Imath::Vec3<T> projected_axis(const Imath::Vec2<T>& axis, const Imath::Vec3<T>& w) {
  const Imath::Vec3<T> projected = w.cross(Imath::Vec3<T>(axis.x, axis.y, 0)).cross(w);
  const T length = projected.length();
  return length > T(0) ? projected / length : across(w, w);
}

}  // namespace abbe
