#include "sensor/film/grouped_median.h"

#include <algorithm>
#include <iterator>

#include "sensor/film/defective_pixels.h"

namespace abbe {

double grouped_median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const double value = values[values.size() / 2];
  const auto [first, last] = std::equal_range(values.begin(), values.end(), value);
  // Extends the step to both sides. A few outliers are defective pixels and no neighbouring code.
  const auto is_step = [&](auto from, auto to) {
    return exceeds_defects(static_cast<double>(std::distance(from, to)), static_cast<double>(values.size()));
  };
  const bool has_below = is_step(values.begin(), first);
  const bool has_above = is_step(last, values.end());
  if (!has_below && !has_above) return value;
  double below = has_below ? (value - *(first - 1)) / 2 : 0;
  double above = has_above ? (*last - value) / 2 : 0;
  if (!has_below) below = above;
  if (!has_above) above = below;
  // Position of the median in the step, from -1 to 1 around its center.
  const double half = static_cast<double>(values.size()) / 2 - static_cast<double>(first - values.begin());
  const double position = 2 * half / static_cast<double>(last - first) - 1;
  return value + position * (position < 0 ? below : above);
}

}  // namespace abbe
