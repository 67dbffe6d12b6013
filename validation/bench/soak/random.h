#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <random>
#include <vector>

namespace abbe::soak {

/// Random generator of a scene. A seed gives the same scene on every platform. The distributions below are
/// written out, since those of the standard library differ between implementations. Only braced lists, whose
/// order is defined, draw twice in one expression.
using Random = std::mt19937_64;

/// Uniform in [low, high); low <= high.
inline double uniform(Random& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11U) * 0x1p-53;
}

/// Log-uniform in [low, high), with 0 < low.
inline double decades(Random& random, double low, double high) {
  return std::exp(uniform(random, std::log(low), std::log(high)));
}

/// True with the given probability in [0, 1].
inline bool chance(Random& random, double probability) {
  return uniform(random, 0, 1) < probability;
}

/// Log-uniform absolute value in [low, high), with 0 < low, and either sign with probability 1/2.
inline double signed_decades(Random& random, double low, double high) {
  const double size = decades(random, low, high);
  return chance(random, 0.5) ? -size : size;
}

/// Uniform integer in [low, high].
inline int integer(Random& random, int low, int high) {
  return low + static_cast<int>(uniform(random, 0, high - low + 1));
}

/// One of the values with equal probabilities; there must be at least one.
template <typename T>
const T& one_of(Random& random, const std::vector<T>& values) {
  return values[static_cast<std::size_t>(integer(random, 0, static_cast<int>(values.size()) - 1))];
}
template <typename T>
T one_of(Random& random, std::initializer_list<T> values) {
  return *std::next(values.begin(), integer(random, 0, static_cast<int>(values.size()) - 1));
}

}  // namespace abbe::soak
