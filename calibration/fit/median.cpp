#include "calibration/fit/median.h"

#include <algorithm>

namespace abbe {

double median(std::vector<double> values) {
  const auto center = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), center, values.end());
  if (values.size() % 2 == 1) return *center;
  return (*std::max_element(values.begin(), center) + *center) / 2;
}

}  // namespace abbe
