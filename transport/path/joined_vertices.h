#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sampling/sampler.h"
#include "transport/path/path_vertex.h"

namespace abbe {

/// Vertices of a path of which each is joined to those of another: see `choose_joined`.
inline constexpr std::size_t kAllJoined = 8;

/// Probability that the vertex of that number, from 1, is joined to those of another path.
[[nodiscard]] inline float joined_share(std::size_t number) {
  return number <= kAllJoined ? 1.0F : static_cast<float>(kAllJoined) / static_cast<float>(number);
}

/// A vertex of a path, by its number from 1, and how often what comes by joining it counts.
struct JoinedVertex {
  std::size_t number = 0;
  float count = 1;
};

/// Which vertices of a path are joined to those of another. Every vertex of one with every vertex of the
/// other, at a cost in proportion to the events of both, would take the third power of their length. So
/// from the ninth on the n-th is joined with the probability p_n = 8/n, 8 (1 + ln(N/8)) of N, and counts
/// 1/p_n [Horvitz1952]: by systematic sampling [Madow1949], where the sum of p_1 ... p_n and one number of
/// the path, between 0 and 1, passes an integer. Those where light goes in a single direction are left out.
void choose_joined(std::span<const PathVertex> path, const Sampler& sampler,
                   std::vector<JoinedVertex>& joined);

}  // namespace abbe
