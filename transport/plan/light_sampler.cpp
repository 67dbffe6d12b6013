#include "transport/plan/light_sampler.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <span>
#include <tuple>
#include <utility>

#include "scene/extent.h"

namespace abbe {
namespace {

constexpr double kUniform = 0.1;  // the part of the choice that asks for no place
constexpr std::size_t kMostRoots = 16;

using Nodes = std::vector<LightNode>;
using Choice = std::span<const std::uint32_t>;

LightScale scale_of(const std::vector<LightLeaf>& leaves, double scene_radius_m) {
  double most = 0;
  for (const auto& [light, bounds] : leaves)
    most = std::max(most, bounds.facing / (bounds.at_infinity ? 1 : scene_radius_m * scene_radius_m));
  constexpr double kLeastDistance = 1e-6;  // of the scene's radius
  return {1 / most, kLeastDistance * scene_radius_m};
}

std::array<std::uint32_t, 2> children(const Nodes& nodes, std::uint32_t node) {
  return {node + 1, nodes[node].next};
}

// The shares of nodes in what they send to a place together; by their lights where that is nothing. Not in
// line, as is the next: `pick` and `probability` have to round alike.
[[gnu::noinline]] void weigh(const Nodes& nodes, Choice choice, const LightSampleContext& place,
                             double* shares) {
  double sum = 0;
  for (std::size_t i = 0; i < choice.size(); ++i)
    sum += shares[i] = static_cast<double>(nodes[choice[i]].importance.irradiance(place));
  if (!(sum > 0)) {
    for (std::size_t i = 0; i < choice.size(); ++i) sum += shares[i] = nodes[choice[i]].lights;
  }
  for (std::size_t i = 0; i < choice.size(); ++i) shares[i] /= sum;
}

// The probability of a node that has the share of what comes to a place, and `lights` of `all`.
[[gnu::noinline]] double probability_of(double share, std::uint32_t lights, std::uint32_t all) {
  return (1 - kUniform) * share + kUniform * lights / all;
}

}  // namespace

LightSampler::LightSampler(const Scene& scene, const std::vector<double>& seen, bool scattering_finds)
    : ways_(scene.lights.size()) {
  std::vector<LightLeaf> leaves;
  for (std::uint32_t i = 0; i < scene.lights.size(); ++i)
    if (seen[i] > 0) leaves.push_back({i, light_bounds(scene.lights[i], scene, seen[i])});
  if (leaves.empty()) return;
  lights_ = static_cast<std::uint32_t>(leaves.size());
  const LightScale scale = scale_of(leaves, scene_radius(scene.bounds));
  unit_ = 1 / scale.strength;
  std::array<std::vector<LightLeaf>, 3> trees;
  for (LightLeaf& leaf : leaves) {
    leaf.bounds.ambient = leaf.bounds.ambient && scattering_finds;
    trees.at(leaf.bounds.ambient ? 2 : leaf.bounds.at_infinity ? 1 : 0).push_back(leaf);
  }
  nodes_.reserve(2 * lights_);
  for (std::vector<LightLeaf>& of : trees) {
    if (of.empty()) continue;
    roots_.push_back(static_cast<std::uint32_t>(nodes_.size()));
    append_tree(std::move(of), scale, nodes_);
  }
  open_roots();
  note_ways();
}

// Replaces those of the most lights by their children, as long as there is room.
void LightSampler::open_roots() {
  const auto fewer = [this](std::uint32_t a, std::uint32_t b) { return nodes_[a].lights < nodes_[b].lights; };
  while (roots_.size() < kMostRoots) {
    const auto most = std::max_element(roots_.begin(), roots_.end(), fewer);
    if (nodes_[*most].lights == 1) return;
    const auto [first, second] = children(nodes_, *most);
    *most = first;
    roots_.insert(std::next(most), second);
  }
}

void LightSampler::note_ways() {
  struct Stop {
    std::uint32_t node;
    int turns;
    Way way;
  };
  std::vector<Stop> stops;
  for (std::uint32_t i = 0; i < roots_.size(); ++i) stops.push_back({roots_[i], 0, {0, i, true}});
  while (!stops.empty()) {
    const auto [at, turns, way] = stops.back();
    stops.pop_back();
    if (nodes_[at].lights == 1) {
      ways_[nodes_[at].next] = way;
      continue;
    }
    const auto [first, second] = children(nodes_, at);
    stops.push_back({first, turns + 1, way});
    stops.push_back({second, turns + 1, {way.turns | std::uint64_t{1} << turns, way.root, true}});
  }
}

double LightSampler::irradiance(const LightSampleContext& place) const {
  double sum = 0;
  for (const std::uint32_t root : roots_)
    sum += static_cast<double>(nodes_[root].importance.irradiance(place));
  return sum * unit_;
}

LightSampler::Pick LightSampler::pick(const LightSampleContext& place, float u) const {
  if (lights_ == 1) return {nodes_.front().next, 1};
  double left = static_cast<double>(u);
  std::array<double, kMostRoots> shares;
  // The first of the nodes whose probabilities reach `left` in sum, and what then is left of it.
  const auto choose = [&](Choice choice, double whole) {
    weigh(nodes_, choice, place, shares.data());
    for (std::size_t i = 0;; ++i) {
      const double share = whole * shares[i];
      const double probability = probability_of(share, nodes_[choice[i]].lights, lights_);
      if (left < probability || i + 1 == choice.size()) return std::tuple(choice[i], share, probability);
      left -= probability;
    }
  };
  auto [at, share, probability] = choose(roots_, 1);
  while (nodes_[at].lights > 1) std::tie(at, share, probability) = choose(children(nodes_, at), share);
  return {nodes_[at].next, static_cast<float>(probability)};
}

float LightSampler::probability(std::uint32_t light, const LightSampleContext& place) const {
  const Way& way = ways_[light];
  if (!way.exists) return 0;
  if (lights_ == 1) return 1;
  std::array<double, kMostRoots> shares;
  weigh(nodes_, roots_, place, shares.data());
  double share = shares[way.root];
  std::uint32_t at = roots_[way.root];
  for (std::uint64_t turns = way.turns; nodes_[at].lights > 1; turns >>= 1U) {
    const std::array<std::uint32_t, 2> choice = children(nodes_, at);
    weigh(nodes_, choice, place, shares.data());
    share *= shares[turns & 1U];
    at = choice[turns & 1U];
  }
  return static_cast<float>(probability_of(share, 1, lights_));
}

}  // namespace abbe
