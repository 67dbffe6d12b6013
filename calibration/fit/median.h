#pragma once

#include <vector>

namespace abbe {

/// The middle one of `values`, of which there is one at least; of an even number the mean of the two.
[[nodiscard]] double median(std::vector<double> values);

}  // namespace abbe
