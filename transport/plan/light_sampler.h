#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.h"
#include "transport/plan/light_tree.h"

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

/// Samples a light for a vertex. Nine in ten samples are in proportion to the unoccluded irradiance; the
/// others are uniform over all lights, because only one of them may be unoccluded. Up to 16 lights are
/// evaluated individually. For more, trees are descended by the irradiance bound of each half [Conty2018]:
/// one for nearby lights and one for lights at infinity. Ambient light is separate.
class LightSampler {
 public:
  using Pick = PowerLightSampler::SampledLight;

  /// `sensor_emissions` is as in `Emissions`, one per light of the scene; lights with 0 are never chosen. Set
  /// `scattering_finds` if emitter hits and NEE are balanced: then glossy vertices leave ambient light to
  /// scattering [Karlik2019].
  LightSampler(const Scene& scene, const std::vector<double>& sensor_emissions, bool scattering_finds);

  /// True if no light can be chosen.
  [[nodiscard]] bool empty() const { return roots_.empty(); }

  /// Total unoccluded irradiance bound at a vertex, as `pick` weights it, in the unit of `sensor_emissions`
  /// times that of `light_bounds` per m^2. 0 if no light can be chosen.
  [[nodiscard]] double irradiance(const LightSampleContext& context) const;

  /// Picks a light for a vertex with `u` in [0, 1), and returns its probability, which is positive.
  /// Neighbouring values of `u` mostly select neighbouring lights. The sampler must not be empty.
  [[nodiscard]] Pick pick(const LightSampleContext& context, float u) const;
  /// Probability with which `pick` chooses the light of index `light` for the vertex; bit-identical to that
  /// of `pick`. 0 for a light that is never chosen.
  [[nodiscard]] float probability(std::uint32_t light, const LightSampleContext& context) const;

 private:
  // Path from a root to a light: bit k is 1 if turn k selects the second child.
  struct TreePath {
    std::uint64_t turns = 0;
    std::uint32_t root = 0;
    bool exists = false;
  };

  void open_roots();
  void record_tree_paths();

  std::vector<LightNode> nodes_;
  // Nodes that cover all lights together; empty if no light can be chosen.
  std::vector<std::uint32_t> roots_;
  std::vector<TreePath> tree_paths_;  // per light of the scene
  std::uint32_t lights_ = 0;          // number of lights that can be chosen
  double unit_ = 0;                   // of the nodes' irradiance
};

}  // namespace abbe
