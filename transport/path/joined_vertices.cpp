#include "transport/path/joined_vertices.h"

#include <cmath>
#include <variant>

#include "transport/path/dimensions.h"

namespace abbe {
namespace {

// True if the vertex scatters into more than single directions, so that it can be connected.
bool is_connectible(const PathVertex& vertex) {
  const auto* surface = std::get_if<SurfaceVertex>(&vertex.at);
  return surface == nullptr || scatters(surface->bsdf);
}

}  // namespace

void choose_joined(std::span<const PathVertex> path, const Sampler& sampler,
                   std::vector<JoinedVertex>& joined) {
  joined.clear();
  double sum = path.size() > kAlwaysJoined ? static_cast<double>(sampler.group(kJoiningGroup)[0]) : 0;
  for (std::size_t number = 1; number <= path.size(); ++number) {
    const float probability = joining_probability(number);
    const double before = std::floor(sum);
    sum += static_cast<double>(probability);
    if (std::floor(sum) > before && is_connectible(path[number - 1]))
      joined.push_back({number, 1 / probability});
  }
}

}  // namespace abbe
