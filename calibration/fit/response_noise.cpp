#include "calibration/fit/response_noise.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "calibration/fit/median.h"

namespace abbe {
namespace {

constexpr double kMadToDeviation = 1.4826;
constexpr std::size_t kGroups = 12;
constexpr std::size_t kMinGroupSize = 32;  // gives the deviation to about a seventh

}  // namespace

double deviation_of(std::vector<double> sizes) {
  return kMadToDeviation * median(std::move(sizes));
}

NoiseByCode::NoiseByCode(std::span<const ResponseSample> samples, std::span<const double> errors) {
  std::vector<std::size_t> order(samples.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return samples[a].code < samples[b].code; });
  const std::size_t groups = std::clamp(samples.size() / kMinGroupSize, std::size_t{1}, kGroups);
  for (std::size_t g = 0; g < groups; ++g) {
    std::vector<double> codes;
    std::vector<double> sizes;
    for (std::size_t i = g * order.size() / groups; i < (g + 1) * order.size() / groups; ++i) {
      codes.push_back(samples[order[i]].code);
      sizes.push_back(errors[order[i]]);
    }
    levels_.push_back({median(std::move(codes)), deviation_of(std::move(sizes))});
  }
}

double NoiseByCode::deviation(double code) const {
  const auto above = std::upper_bound(levels_.begin(), levels_.end(), code,
                                      [](double c, const Level& level) { return c < level.code; });
  if (above == levels_.begin()) return levels_.front().deviation;
  if (above == levels_.end()) return levels_.back().deviation;
  const Level& below = *(above - 1);
  return std::lerp(below.deviation, above->deviation, (code - below.code) / (above->code - below.code));
}

}  // namespace abbe
