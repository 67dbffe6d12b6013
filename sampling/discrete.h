#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

namespace abbe {

/// Result of inverting a cumulative distribution: the step, and the position inside it.
template <typename Number>
struct CdfStep {
  std::size_t index;  ///< Index of the step, from 0.
  Number within;      ///< Position inside the step in [0, 1]: a new uniform random number, or an offset for a
                      ///< constant density.
};

/// Divides running sums of weights >= 0 by their last element, which makes them a cumulative distribution.
/// `sums` must not be empty. Leaves `sums` unchanged if the last element is not positive.
template <typename T>
void normalise_cdf(std::span<T> sums) {
  const T total = sums.back();
  if (!(total > 0)) return;
  for (T& sum : sums) sum /= total;
}

/// Inverts the cumulative distribution `cdf` at `u` in [0, 1). Step i has the probability cdf[i] - cdf[i -
/// 1]. Never returns a step of probability 0, not even if rounding left the last value below 1 and `u` above
/// it. Requires ascending values, the last one above 0. Computes in the precision of `u`.
template <typename T, typename Number>
[[nodiscard]] CdfStep<Number> invert_cdf(std::span<const T> cdf, Number u) {
  const auto at = [&cdf](std::size_t i) { return static_cast<Number>(cdf[i]); };
  const auto low = [&at](std::size_t i) { return i > 0 ? at(i - 1) : Number(0); };
  const auto above = std::upper_bound(cdf.begin(), cdf.end(), u,
                                      [](Number x, T value) { return x < static_cast<Number>(value); });
  auto index = std::min(static_cast<std::size_t>(above - cdf.begin()), cdf.size() - 1);
  while (index > 0 && at(index) == low(index)) --index;
  return {index, std::clamp((u - low(index)) / (at(index) - low(index)), Number(0), Number(1))};
}

/// Probability of step `index` < `cdf.size()` of a normalised cumulative distribution.
template <typename T>
[[nodiscard]] T cdf_step(std::span<const T> cdf, std::size_t index) {
  return cdf[index] - (index > 0 ? cdf[index - 1] : T(0));
}

}  // namespace abbe
