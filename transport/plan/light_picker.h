#pragma once

#include <cstdint>
#include <vector>

namespace abbe {

/// A discrete distribution over the lights of a scene.
class LightPicker {
 public:
  /// Proportional to `weights`, nine parts in ten, and uniform over the lights of positive weight for the
  /// rest.
  explicit LightPicker(const std::vector<double>& weights);

  struct Pick {
    std::uint32_t light;
    float probability;
  };
  [[nodiscard]] Pick pick(float u) const;
  [[nodiscard]] float probability(std::uint32_t light) const { return probability_[light]; }
  [[nodiscard]] bool empty() const { return cdf_.empty(); }

 private:
  std::vector<float> cdf_;  // empty when no light has weight
  std::vector<float> probability_;
};

}  // namespace abbe
