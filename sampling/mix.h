#pragma once

#include <cstdint>

namespace abbe {

/// A bijection of 32-bit numbers with full avalanche [Wellons2018]; T may be a vector of them.
template <typename T>
constexpr T mix(T x) {
  x ^= x >> 16;
  x *= 0x7feb352dU;
  x ^= x >> 15;
  x *= 0x846ca68bU;
  x ^= x >> 16;
  return x;
}

/// A hash of both numbers.
template <typename T>
constexpr T combine(T a, T b) {
  return mix(a ^ (mix(b) + 0x9e3779b9U));
}

}  // namespace abbe
