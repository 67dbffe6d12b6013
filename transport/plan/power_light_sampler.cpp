#include "transport/plan/power_light_sampler.h"

#include <algorithm>
#include <numeric>
#include <span>

#include "sampling/discrete.h"

namespace abbe {

PowerLightSampler::PowerLightSampler(const std::vector<double>& weights)
    : probability_(weights.size(), 0.0F) {
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  if (!(total > 0)) return;
  const auto positive =
      static_cast<double>(std::count_if(weights.begin(), weights.end(), [](double w) { return w > 0; }));
  double sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double p = weights[i] > 0 ? 0.9 * weights[i] / total + 0.1 / positive : 0;
    probability_[i] = static_cast<float>(p);
    sum += p;
    cdf_.push_back(static_cast<float>(sum));
  }
}

PowerLightSampler::SampledLight PowerLightSampler::pick(float u) const {
  const auto light = static_cast<std::uint32_t>(invert_cdf(std::span<const float>(cdf_), u).index);
  return {light, probability_[light]};
}

}  // namespace abbe
