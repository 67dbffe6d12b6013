#pragma once

#include <cstdint>
#include <vector>

namespace abbe {

/// A discrete distribution over the lights of a scene.
class PowerLightSampler {
 public:
  /// Proportional to `weights`, nine parts in ten, and uniform over the lights of positive weight for the
  /// rest.
  explicit PowerLightSampler(const std::vector<double>& weights);

  struct SampledLight {
    std::uint32_t light;
    float probability;
  };
  [[nodiscard]] SampledLight pick(float u) const;
  [[nodiscard]] float probability(std::uint32_t light) const { return probability_[light]; }
  [[nodiscard]] bool empty() const { return cdf_.empty(); }

 private:
  std::vector<float> cdf_;  // empty when no light has weight
  std::vector<float> probability_;
};

}  // namespace abbe
