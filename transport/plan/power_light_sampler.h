#pragma once

#include <cstdint>
#include <vector>

namespace abbe {

/// Discrete distribution over the lights of a scene.
class PowerLightSampler {
 public:
  /// Nine in ten samples are in proportion to `weights`, one per light and not negative. The others are
  /// uniform over the lights of positive weight.
  explicit PowerLightSampler(const std::vector<double>& weights);

  struct SampledLight {
    std::uint32_t light;  ///< Index into `Scene::lights`.
    float probability;    ///< Probability of choosing this light.
  };
  /// Picks a light with `u` in [0, 1). The distribution must not be empty.
  [[nodiscard]] SampledLight pick(float u) const;
  /// Probability with which `pick` chooses a light; 0 for one without weight.
  [[nodiscard]] float probability(std::uint32_t light) const { return probability_[light]; }
  /// True if no light has weight.
  [[nodiscard]] bool empty() const { return cdf_.empty(); }

 private:
  std::vector<float> cdf_;  // empty if no light has weight
  std::vector<float> probability_;
};

}  // namespace abbe
