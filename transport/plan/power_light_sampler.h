#pragma once

#include <cstdint>
#include <vector>

namespace abbe {

/// Discrete distribution over the lights of a scene.
class PowerLightSampler {
 public:
  /// Nine in ten samples are in proportion to `weights`, the others uniform over the lights of positive
  /// weight.
  explicit PowerLightSampler(const std::vector<double>& weights);

  struct SampledLight {
    std::uint32_t light;
    float probability;
  };
  [[nodiscard]] SampledLight pick(float u) const;
  [[nodiscard]] float probability(std::uint32_t light) const { return probability_[light]; }
  [[nodiscard]] bool empty() const { return cdf_.empty(); }

 private:
  std::vector<float> cdf_;  // empty if no light has weight
  std::vector<float> probability_;
};

}  // namespace abbe
