#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sampling/sampler.h"
#include "transport/path/path_vertex.h"

namespace abbe {

/// Number of vertices of a path that are always connected; see `choose_joined`.
inline constexpr std::size_t kAlwaysJoined = 8;

/// Probability that vertex `number`, at least 1, is connected to the vertices of another path.
[[nodiscard]] inline float joining_probability(std::size_t number) {
  return number <= kAlwaysJoined ? 1.0F : static_cast<float>(kAlwaysJoined) / static_cast<float>(number);
}

/// Vertex of a path that is connected to another path.
struct JoinedVertex {
  std::size_t number = 0;  ///< Number of the vertex in its path, from 1.
  float weight = 1;        ///< Factor 1/p_n of its connections.
};

/// Chooses the vertices of a path that are connected to another path. Connecting all pairs, each at a cost in
/// proportion to the lengths of both, would cost the third power of the length. From the ninth on, vertex n
/// is therefore connected with the probability p_n = 8/n and the weight 1/p_n [Horvitz1952]. This selects
/// about 8 (1 + ln(N/8)) of N vertices. Sampling is systematic [Madow1949]: a vertex is chosen if the sum of
/// p_1 ... p_n and one random number of `sampler` passes an integer. Surface vertices with delta
/// distributions only are left out. Replaces the content of `joined`; its numbers ascend.
void choose_joined(std::span<const PathVertex> path, const Sampler& sampler,
                   std::vector<JoinedVertex>& joined);

}  // namespace abbe
