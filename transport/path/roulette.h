#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

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

/// The `a` of `survival`: of paths whose cost is in proportion to their events, of those whose last event was
/// specular, and, at surfaces, of those that are joined to others at many of their vertices.
inline constexpr float kEndingOfPaths = 0.5F;
inline constexpr float kEndingOfSpecularPaths = 1;
inline constexpr float kEndingOfJoinedPaths = 2;

/// Probability that a path goes on after so many events when it carries `throughput`: that, within [0.1, 1]
/// [Marschner2021, sec. 14.4], and beyond 64 events no more than 1 - a/events, so that paths end where
/// nothing is absorbed. What goes on is divided by it, so the mean stays what it is, and the weight of a path
/// of n events grows as n^a. Light comes out of a thick white cloud after n events with a probability in
/// proportion to n^(-3/2), so that the second moment of what it carries, the sum of n^(a - 3/2), is finite
/// for a < 1/2, while the events of a path are in proportion to the sum of n^(-1/2 - a). Their product is
/// least for a = 1/2 up to the most events there are. Light that total reflection holds in clear glass for
/// ever ends ten times sooner by a = 1. Paths that are joined to others end sooner still at surfaces, by
/// a = 2, since these absorb enough to leave little for long ones; clouds do not.
[[nodiscard]] inline float survival(float throughput, int events, float a) {
  const float most = events > kLongPath ? 1 - a / static_cast<float>(events) : 1;
  return std::min(most, std::max(0.1F, throughput));
}

/// By how many times what it carries a camera path plays roulette that is connected to lights as it goes: it
/// goes on for sure while it carries a quarter. Where a share N_n of the paths has n events and these carry
/// T_n, their light has a variance in proportion to T_n^2/N_n and costs N_n, so that N_n is best in
/// proportion to T_n: that is roulette by what is carried, whatever the factor. The larger it is, the less of
/// all noise is that of long paths, and the more of all time; between 2.5 and 6 error costs least in scenes
/// of many kinds.
inline constexpr float kGoingOnOfCameraPaths = 4;

/// The share of the paths which roulette lets have so many events, where nothing but it ends them and a is
/// 1/2: the product of `survival`, about.
[[nodiscard]] inline float kept_share(std::size_t events) {
  return events > kLongPath ? std::sqrt(kLongPath / static_cast<float>(events)) : 1.0F;
}

}  // namespace abbe
