#pragma once

#include <algorithm>

#include "scene/scene.h"

namespace abbe {

/// Events after which a path is most likely to end: see `survival`.
inline constexpr int kLongPath = 64;

/// Events after which any path is cut, and counted as cut, that nothing else has ended. Never a time, so that
/// the same paths are cut wherever they are traced.
inline constexpr int kMostEvents = 100000;

/// Most events of a path of the scene, at surfaces and within matter, between its ends.
[[nodiscard]] inline int most_events(const RenderSettings& render) {
  return std::min(render.max_depth.value_or(kMostEvents), kMostEvents);
}

/// Whether Russian roulette decides if a path goes on that has had so many events.
[[nodiscard]] inline bool plays_roulette(const RenderSettings& render, int events) {
  return render.roulette_depth >= 0 && events >= render.roulette_depth;
}

/// Probability that a path goes on after so many events when it carries `throughput`: that, within [0.1, 1]
/// [Marschner2021, sec. 14.4], and beyond 64 events no more than 1 - 2/events, so that paths end where
/// nothing is absorbed. What goes on is divided by it, so the mean stays what it is. The weight of a path of
/// n events then grows as n^2, which any loss that goes on, however small, outdoes; one that grew
/// exponentially, as of a constant probability, would leave the variance of a dense white cloud infinite.
[[nodiscard]] inline float survival(float throughput, int events) {
  const float most = events > kLongPath ? 1 - 2 / static_cast<float>(events) : 1;
  return std::min(most, std::max(0.1F, throughput));
}

}  // namespace abbe
