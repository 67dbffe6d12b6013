#pragma once

#include <limits>

#include <ImathVec.h>

namespace abbe {

/// A half line, or its first `t_max`; lengths in metres, `direction` of unit length.
template <typename T>
struct BasicRay {
  Imath::Vec3<T> origin;
  Imath::Vec3<T> direction;
  T t_max = std::numeric_limits<T>::infinity();
};
using Ray = BasicRay<float>;

/// A ray as it was asked of a scene: for its nearest hit, or whether anything blocks it.
struct LoggedRay {
  Ray ray;
  bool shadow;
};

}  // namespace abbe
