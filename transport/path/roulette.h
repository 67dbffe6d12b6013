#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "scene/scene.h"

namespace abbe {

/// Depth above which paths end more often; see `survival`.
inline constexpr int kLongPath = 64;

/// Depth at which every path is truncated, and counted as such. A limit on depth, unlike one on time,
/// truncates the same paths on every machine.
inline constexpr int kMaxPathDepth = 100000;

/// Maximum number of scattering events of the scene's paths, on surfaces and in media:
/// `RenderSettings::max_depth` if it is set, at most `kMaxPathDepth`.
[[nodiscard]] inline int depth_limit(const RenderSettings& render) {
  return std::min(render.max_depth.value_or(kMaxPathDepth), kMaxPathDepth);
}

/// True if Russian roulette applies to a path of this depth; never if the scene's roulette depth is negative.
[[nodiscard]] inline bool plays_roulette(const RenderSettings& render, int depth) {
  return render.roulette_depth >= 0 && depth >= render.roulette_depth;
}

/// Exponents `a` of `survival`: for paths whose cost is in proportion to their length; for paths whose last
/// event was specular; at surfaces, for paths that are connected at many of their vertices.
inline constexpr float kPathRouletteExponent = 0.5F;
inline constexpr float kSpecularRouletteExponent = 1;
inline constexpr float kJoinedRouletteExponent = 2;

/// Probability in (0, 1] that a path of this depth survives roulette: `throughput`, clamped to [0.1, 1]
/// [Marschner2021, sec. 14.4], and above depth 64 at most 1 - a/depth. The bound ends paths even if nothing
/// absorbs them. Survivors are divided by the probability, so the estimate stays unbiased and the weight at
/// depth n grows as n^a.
///
/// Light leaves a thick white cloud at depth n with a probability in proportion to n^(-3/2). The second
/// moment, the sum of n^(a - 3/2), is finite for a < 1/2, and the mean length is in proportion to the sum of
/// n^(-1/2 - a). Their product is smallest for a = 1/2, up to the maximum depth. With a = 1, light trapped by
/// total reflection in clear glass ends ten times sooner. Connected paths use a = 2 at surfaces, which absorb
/// enough to leave little for long paths; clouds do not.
[[nodiscard]] inline float survival(float throughput, int depth, float a) {
  const float max_survival = depth > kLongPath ? 1 - a / static_cast<float>(depth) : 1;
  return std::min(max_survival, std::max(0.1F, throughput));
}

/// Factor between the throughput of a camera path with NEE and its survival probability: the path certainly
/// survives while it carries a quarter. Let a fraction N_n of the paths get to depth n with the throughput
/// T_n. Their variance is in proportion to T_n^2/N_n, their cost to N_n. The best N_n is in proportion to
/// T_n, which is roulette by throughput with any factor. A larger factor lowers the noise of long paths and
/// increases their time. Factors between 2.5 and 6 have the lowest cost for a given error in many scenes.
inline constexpr float kCameraRouletteScale = 4;

/// Approximate fraction of paths that roulette lets get to a depth if nothing else ends them and a is 1/2:
/// the product of `survival`.
[[nodiscard]] inline float survival_fraction(std::size_t depth) {
  return depth > kLongPath ? std::sqrt(kLongPath / static_cast<float>(depth)) : 1.0F;
}

}  // namespace abbe
