#pragma once

#include <vector>

namespace abbe {

/// The median of `values`, of which there is one at least. Equal ones, as codes are, stand for a step that
/// reaches halfway to their neighbours, to both sides alike where there is but one, and are spread over it
/// evenly: so the median of codes is finer than their steps, as is their mean. Where as few lie to one side
/// as may be defective (`exceeds_defects`), they are no neighbours.
[[nodiscard]] double grouped_median(std::vector<double> values);

}  // namespace abbe
