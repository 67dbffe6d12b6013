#include "transport/plan/light_tree.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>

namespace abbe {
namespace {

constexpr std::size_t kBuckets = 12;
constexpr int kMaxUnevenTurns = 32;  // depth after which halves are equal, for fewer than 2^32 lights

Imath::Box3d box_of_centers(std::span<const LightLeaf> leaves) {
  Imath::Box3d box;
  for (const LightLeaf& leaf : leaves) box.extendBy(leaf.bounds.box.center());
  return box;
}

// Buckets along an axis that start at `from` and span `width`.
struct Buckets {
  unsigned axis;
  double from;
  double width;

  [[nodiscard]] std::size_t of(const LightLeaf& leaf) const {
    const double fraction = (leaf.bounds.box.center()[axis] - from) / width;
    return std::min(kBuckets - 1, static_cast<std::size_t>(fraction * kBuckets));
  }
};

void include(std::optional<LightBounds>& sum, const LightBounds& more) {
  sum = sum ? union_of(*sum, more) : more;
}

// Cost of a half: the measure of [Conty2018], with the sphere around the lights instead of their box, because
// the sphere bounds the irradiance of a node.
double cost(const std::optional<LightBounds>& half) {
  return half ? half->facing * half->radius * half->radius * measure(half->cone) : 0;
}

// Number of buckets in the first half of the best split.
std::size_t best_split(const std::array<std::optional<LightBounds>, kBuckets>& in) {
  std::array<double, kBuckets> costs{};
  std::optional<LightBounds> sum;
  for (std::size_t i = 1; i < kBuckets; ++i) {
    if (in[i - 1]) include(sum, *in[i - 1]);
    costs[i] = cost(sum);
  }
  sum.reset();
  for (std::size_t i = kBuckets - 1; i > 0; --i) {
    if (in[i]) include(sum, *in[i]);
    costs[i] += cost(sum);
  }
  return static_cast<std::size_t>(std::min_element(costs.begin() + 1, costs.end()) - costs.begin());
}

// Partitions the leaves and returns the number of those in the first half.
std::size_t split_leaves(std::span<LightLeaf> leaves, int turns) {
  const Imath::Box3d centers = box_of_centers(leaves);
  const unsigned axis = centers.majorAxis();
  const Buckets buckets{axis, centers.min[axis], centers.size()[axis]};
  const std::size_t half = leaves.size() / 2;
  if (!(buckets.width > 0)) return half;
  if (turns >= kMaxUnevenTurns) {
    std::nth_element(leaves.begin(), leaves.begin() + static_cast<std::ptrdiff_t>(half), leaves.end(),
                     [axis](const LightLeaf& a, const LightLeaf& b) {
                       return a.bounds.box.center()[axis] < b.bounds.box.center()[axis];
                     });
    return half;
  }
  std::array<std::optional<LightBounds>, kBuckets> in;
  for (const LightLeaf& leaf : leaves) include(in[buckets.of(leaf)], leaf.bounds);
  const std::size_t first = best_split(in);
  const auto boundary = std::partition(leaves.begin(), leaves.end(),
                                       [&](const LightLeaf& leaf) { return buckets.of(leaf) < first; });
  return static_cast<std::size_t>(boundary - leaves.begin());
}

class Builder {
 public:
  Builder(const LightScale& scale, std::vector<LightNode>& nodes) : scale_(scale), nodes_(nodes) {}

  LightBounds append(std::span<LightLeaf> leaves, int turns) {
    const std::size_t at = nodes_.size();
    if (leaves.size() == 1) {
      nodes_.push_back({importance(leaves[0].bounds), 1, leaves[0].light});
      return leaves[0].bounds;
    }
    const std::size_t first = split_leaves(leaves, turns);
    // Placeholder: its importance is set after both children.
    nodes_.push_back({importance(leaves[0].bounds), static_cast<std::uint32_t>(leaves.size()), 0});
    const LightBounds one = append(leaves.first(first), turns + 1);
    nodes_[at].next = static_cast<std::uint32_t>(nodes_.size());
    LightBounds all = union_of(one, append(leaves.subspan(first), turns + 1));
    nodes_[at].importance = importance(all);
    return all;
  }

 private:
  [[nodiscard]] LightImportance importance(const LightBounds& bounds) const {
    return {bounds, scale_.strength, scale_.min_distance};
  }

  const LightScale& scale_;
  std::vector<LightNode>& nodes_;
};

}  // namespace

void append_tree(std::vector<LightLeaf> leaves, const LightScale& scale, std::vector<LightNode>& nodes) {
  Builder(scale, nodes).append(leaves, 0);
}

}  // namespace abbe
