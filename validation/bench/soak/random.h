#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <random>
#include <vector>

namespace abbe::soak {

/// The draws of a scene. The distributions of the standard library differ from one implementation to the
/// next, so those below are written out, and no expression draws twice but lists in braces, which have an
/// order: a seed means the same scene everywhere.
using Random = std::mt19937_64;

/// Uniform in [low, high).
inline double uniform(Random& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11U) * 0x1p-53;
}

/// Uniform in the logarithm, in [low, high) with 0 < low.
inline double decades(Random& random, double low, double high) {
  return std::exp(uniform(random, std::log(low), std::log(high)));
}

inline bool chance(Random& random, double probability) {
  return uniform(random, 0, 1) < probability;
}

/// As `decades`, of either sign.
inline double signed_decades(Random& random, double low, double high) {
  const double size = decades(random, low, high);
  return chance(random, 0.5) ? -size : size;
}

/// Uniform in [low, high], both included.
inline int integer(Random& random, int low, int high) {
  return low + static_cast<int>(uniform(random, 0, high - low + 1));
}

/// One of some values, each as likely as another.
template <typename T>
const T& one_of(Random& random, const std::vector<T>& values) {
  return values[static_cast<std::size_t>(integer(random, 0, static_cast<int>(values.size()) - 1))];
}
template <typename T>
T one_of(Random& random, std::initializer_list<T> values) {
  return *std::next(values.begin(), integer(random, 0, static_cast<int>(values.size()) - 1));
}

}  // namespace abbe::soak
