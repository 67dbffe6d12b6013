#pragma once

#include <vector>

namespace abbe {

/// Median of grouped data. `values` must not be empty. Equal values, such as codes, are spread evenly over a
/// step that extends halfway to the neighbouring values. With a neighbour on one side only, the step is
/// symmetric. The median of codes is therefore finer than one code, like their mean. A side with so few
/// values that they may be defective (`exceeds_defects`) has no neighbour.
[[nodiscard]] double grouped_median(std::vector<double> values);

}  // namespace abbe
