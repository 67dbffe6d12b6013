#include "sensor/readout/code_levels.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace abbe {

// Widths may differ from code to code. If the noise is wider than they are, a signal y of the converter gives
// the code y + q, with q uniform on [-1/2, 1/2] and independent of y.
std::vector<CodeLevel> code_levels(const Readout& readout) {
  constexpr std::size_t kCodes = 1U << 16U;
  std::vector<CodeLevel> levels;
  for (std::size_t code = 0; code < kCodes; ++code) levels.push_back({static_cast<double>(code), 1.0 / 12});
  const auto signal = [&](double dn) {
    return readout.offset_dn + electrons_of(readout, dn) / readout.gain_e_per_dn;
  };
  const std::vector<std::uint16_t> straight = linear_codes(readout);
  auto next = straight.begin();
  while (next != straight.end()) {
    auto first = next;
    next = std::upper_bound(first, straight.end(), *first);
    const auto code = [&](auto at) { return static_cast<double>(at - straight.begin()); };
    // Signals below the lowest code are clipped.
    while (first + 1 != next && signal(code(first)) < -0.5) ++first;
    const double low = signal(code(first) - 0.5);
    const double width = signal(code(next) - 0.5) - low;
    levels[*first] = {low + width / 2, width * width / 12};
  }
  return levels;
}

}  // namespace abbe
