#pragma once

#include <vector>

namespace abbe {

/// Median of `values`, which must not be empty; for an even number, the mean of the central two.
[[nodiscard]] double median(std::vector<double> values);

}  // namespace abbe
