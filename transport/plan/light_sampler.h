#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.h"
#include "transport/plan/light_tree.h"
#include "transport/plan/power_light_sampler.h"

namespace abbe {

/// Chooses a light for a place: by what each sends there, nothing standing in between, nine parts in ten, and
/// uniformly over all lights for the rest, so that none starves where it alone is not hidden. Up to 16 lights
/// are weighed one by one. Of more, trees are descended by what each half sends [Conty2018], one over the
/// lamps and one over the lights at infinity; light that is the same from all directions is by itself.
class LightSampler {
 public:
  using Pick = PowerLightSampler::SampledLight;

  /// `seen` stands for each light's emission, as in `Emissions`; lights of 0 are never chosen. Where
  /// scattering finds light too, and both ways are balanced, glossy places leave what is the same from all
  /// directions to it [Karlik2019]: it sends them nothing.
  LightSampler(const Scene& scene, const std::vector<double>& seen, bool scattering_finds);

  /// Whether no light can be chosen.
  [[nodiscard]] bool empty() const { return roots_.empty(); }

  /// Irradiance at a place by all lights together, nothing standing in between, as `pick` weighs them, in the
  /// unit of `seen` times what `light_bounds` measures by.
  [[nodiscard]] double irradiance(const LightSampleContext& place) const;

  /// A light for a place. `u` is in [0, 1); the lights follow each other along it, neighbours in space mostly
  /// near.
  [[nodiscard]] Pick pick(const LightSampleContext& place, float u) const;
  /// Probability with which `pick` chooses that light for that place: the same number to the bit.
  [[nodiscard]] float probability(std::uint32_t light, const LightSampleContext& place) const;

 private:
  // From a root to a light: bit k says whether turn k goes to the second child.
  struct Way {
    std::uint64_t turns = 0;
    std::uint32_t root = 0;
    bool exists = false;
  };

  void open_roots();
  void note_ways();

  std::vector<LightNode> nodes_;
  std::vector<std::uint32_t> roots_;  // nodes that stand for all lights together; empty when no light is seen
  std::vector<Way> ways_;             // of each light of the scene
  std::uint32_t lights_ = 0;          // that can be chosen
  double unit_ = 0;                   // of what the nodes send
};

}  // namespace abbe
