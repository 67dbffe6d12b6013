#include "transport/plan/light_sampler.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

#include "sampling/discrete.h"
#include "scene/working_range.h"

namespace abbe {

PowerLightSampler::PowerLightSampler(const std::vector<double>& weights)
    : probability_(weights.size(), 0.0F) {
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  if (!(total > 0)) return;
  const auto positive =
      static_cast<double>(std::count_if(weights.begin(), weights.end(), [](double w) { return w > 0; }));
  double sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double p = weights[i] > 0 ? 0.9 * weights[i] / total + 0.1 / positive : 0;
    probability_[i] = static_cast<float>(p);
    sum += p;
    cdf_.push_back(static_cast<float>(sum));
  }
}

PowerLightSampler::SampledLight PowerLightSampler::pick(float u) const {
  const auto light = static_cast<std::uint32_t>(invert_cdf(std::span<const float>(cdf_), u).index);
  return {light, probability_[light]};
}

namespace {

constexpr double kUniform = 0.1;  // defensive fraction
constexpr std::size_t kMaxRoots = 16;

using Nodes = std::vector<LightNode>;
using Choice = std::span<const std::uint32_t>;

LightScale scale_of(const std::vector<LightLeaf>& leaves, double scene_radius_m) {
  double largest = 0;
  for (const auto& [light, bounds] : leaves)
    largest = std::max(largest, bounds.facing / (bounds.at_infinity ? 1 : scene_radius_m * scene_radius_m));
  constexpr double kMinRelativeDistance = 1e-6;  // fraction of the scene's radius
  return {1 / largest, kMinRelativeDistance * scene_radius_m};
}

std::array<std::uint32_t, 2> children(const Nodes& nodes, std::uint32_t node) {
  return {node + 1, nodes[node].next};
}

// Fractions of the nodes in their total irradiance bound at a vertex; by number of lights if that is 0.
// Neither this nor the next function is inlined: `pick` and `probability` must round alike.
[[gnu::noinline]] void weigh(const Nodes& nodes, Choice choice, const LightSampleContext& context,
                             double* fractions) {
  double sum = 0;
  for (std::size_t i = 0; i < choice.size(); ++i)
    sum += fractions[i] = static_cast<double>(nodes[choice[i]].importance.irradiance(context));
  if (!(sum > 0)) {
    for (std::size_t i = 0; i < choice.size(); ++i) sum += fractions[i] = nodes[choice[i]].lights;
  }
  for (std::size_t i = 0; i < choice.size(); ++i) fractions[i] /= sum;
}

// Probability of a node with the given fraction of the irradiance and `lights` of `all` lights.
[[gnu::noinline]] double probability_of(double fraction, std::uint32_t lights, std::uint32_t all) {
  return (1 - kUniform) * fraction + kUniform * lights / all;
}

}  // namespace

LightSampler::LightSampler(const Scene& scene, const std::vector<double>& sensor_emissions,
                           bool scattering_finds)
    : tree_paths_(scene.lights.size()) {
  std::vector<LightLeaf> leaves;
  for (std::uint32_t i = 0; i < scene.lights.size(); ++i)
    if (sensor_emissions[i] > 0)
      leaves.push_back({i, light_bounds(scene.lights[i], scene.shapes, sensor_emissions[i])});
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
  record_tree_paths();
}

// Replaces the roots with most lights by their children, up to `kMaxRoots`.
void LightSampler::open_roots() {
  const auto fewer = [this](std::uint32_t a, std::uint32_t b) { return nodes_[a].lights < nodes_[b].lights; };
  while (roots_.size() < kMaxRoots) {
    const auto largest = std::max_element(roots_.begin(), roots_.end(), fewer);
    if (nodes_[*largest].lights == 1) return;
    const auto [first, second] = children(nodes_, *largest);
    *largest = first;
    roots_.insert(std::next(largest), second);
  }
}

void LightSampler::record_tree_paths() {
  struct Stop {
    std::uint32_t node;
    int turns;
    TreePath path;
  };
  std::vector<Stop> stops;
  for (std::uint32_t i = 0; i < roots_.size(); ++i) stops.push_back({roots_[i], 0, {0, i, true}});
  while (!stops.empty()) {
    const auto [at, turns, path] = stops.back();
    stops.pop_back();
    if (nodes_[at].lights == 1) {
      tree_paths_[nodes_[at].next] = path;
      continue;
    }
    const auto [first, second] = children(nodes_, at);
    stops.push_back({first, turns + 1, path});
    stops.push_back({second, turns + 1, {path.turns | std::uint64_t{1} << turns, path.root, true}});
  }
}

double LightSampler::irradiance(const LightSampleContext& context) const {
  double sum = 0;
  for (const std::uint32_t root : roots_)
    sum += static_cast<double>(nodes_[root].importance.irradiance(context));
  return sum * unit_;
}

LightSampler::Pick LightSampler::pick(const LightSampleContext& context, float u) const {
  if (lights_ == 1) return {nodes_.front().next, 1};
  double remaining = static_cast<double>(u);
  std::array<double, kMaxRoots> fractions;
  // Selects the first node whose cumulative probability exceeds `remaining`, and subtracts the others.
  const auto choose = [&](Choice choice, double whole) {
    weigh(nodes_, choice, context, fractions.data());
    for (std::size_t i = 0;; ++i) {
      const double fraction = whole * fractions[i];
      const double probability = probability_of(fraction, nodes_[choice[i]].lights, lights_);
      if (remaining < probability || i + 1 == choice.size())
        return std::tuple(choice[i], fraction, probability);
      remaining -= probability;
    }
  };
  auto [at, fraction, probability] = choose(roots_, 1);
  while (nodes_[at].lights > 1) std::tie(at, fraction, probability) = choose(children(nodes_, at), fraction);
  return {nodes_[at].next, static_cast<float>(probability)};
}

float LightSampler::probability(std::uint32_t light, const LightSampleContext& context) const {
  const TreePath& path = tree_paths_[light];
  if (!path.exists) return 0;
  if (lights_ == 1) return 1;
  std::array<double, kMaxRoots> fractions;
  weigh(nodes_, roots_, context, fractions.data());
  double fraction = fractions[path.root];
  std::uint32_t at = roots_[path.root];
  for (std::uint64_t turns = path.turns; nodes_[at].lights > 1; turns >>= 1U) {
    const std::array<std::uint32_t, 2> choice = children(nodes_, at);
    weigh(nodes_, choice, context, fractions.data());
    fraction *= fractions[turns & 1U];
    at = choice[turns & 1U];
  }
  return static_cast<float>(probability_of(fraction, 1, lights_));
}

}  // namespace abbe
