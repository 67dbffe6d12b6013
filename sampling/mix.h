#pragma once

#include <cstdint>

namespace abbe {

/// Bijection of 32-bit integers with full avalanche [Wellons2018]. T is `std::uint32_t` or a SIMD vector of
/// it.
template <typename T>
constexpr T mix(T x) {
  x ^= x >> 16;
  x *= 0x7feb352dU;
  x ^= x >> 15;
  x *= 0x846ca68bU;
  x ^= x >> 16;
  return x;
}

/// Hash of two integers, which depends on their order.
template <typename T>
constexpr T combine(T a, T b) {
  return mix(a ^ (mix(b) + 0x9e3779b9U));
}

}  // namespace abbe
