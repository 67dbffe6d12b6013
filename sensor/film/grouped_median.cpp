#include "sensor/film/grouped_median.h"

#include <algorithm>
#include <cmath>

namespace abbe {

double grouped_median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const double value = values[values.size() / 2];
  const auto [first, last] = std::equal_range(values.begin(), values.end(), value);
  if (first == values.begin() && last == values.end()) return value;
  // To the ends of the step.
  double below = first == values.begin() ? 0 : (value - *(first - 1)) / 2;
  double above = last == values.end() ? 0 : (*last - value) / 2;
  if (first == values.begin()) below = above;
  if (last == values.end()) above = below;
  // Where half of all values is reached, as a share of the step from its middle, to -1 and 1.
  const double half = static_cast<double>(values.size()) / 2 - static_cast<double>(first - values.begin());
  const double share = 2 * half / static_cast<double>(last - first) - 1;
  return value + share * (share < 0 ? below : above);
}

}  // namespace abbe
