#include "transport/path/joined_vertices.h"

#include <cmath>
#include <variant>

#include "transport/path/dimensions.h"

namespace abbe {
namespace {

// Whether light goes there in more than single directions, so that it can be connected to something.
bool joins(const PathVertex& vertex) {
  const auto* surface = std::get_if<SurfaceVertex>(&vertex.at);
  return surface == nullptr || scatters(surface->bsdf);
}

}  // namespace

void choose_joined(std::span<const PathVertex> path, const Sampler& sampler,
                   std::vector<JoinedVertex>& joined) {
  joined.clear();
  double sum = path.size() > kAllJoined ? static_cast<double>(sampler.group(kJoiningGroup)[0]) : 0;
  for (std::size_t number = 1; number <= path.size(); ++number) {
    const float share = joined_share(number);
    const double before = std::floor(sum);
    sum += static_cast<double>(share);
    if (std::floor(sum) > before && joins(path[number - 1])) joined.push_back({number, 1 / share});
  }
}

}  // namespace abbe
