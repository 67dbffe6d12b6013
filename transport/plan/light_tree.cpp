#include "transport/plan/light_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

namespace abbe {
namespace {

// Unit vector at the angle `turn` from `axis`, rotated towards `towards`.
Imath::V3d turned(const Imath::V3d& axis, const Imath::V3d& towards, double turn) {
  const Imath::V3d across = towards - axis * axis.dot(towards);
  return (axis * std::cos(turn) + across.normalized() * std::sin(turn)).normalized();
}

// cos(max(0, a - b)) of two angles in [0, pi], given their cosines.
float cos_excess(float cos_a, float cos_b) {
  if (cos_a >= cos_b) return 1;
  return cos_a * cos_b + std::sqrt(std::max(0.0F, (1 - cos_a * cos_a) * (1 - cos_b * cos_b)));
}

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

EmissionCone union_of(const EmissionCone& a, const EmissionCone& b) {
  const EmissionCone& wide = a.spread >= b.spread ? a : b;
  const EmissionCone& narrow = a.spread >= b.spread ? b : a;
  const double falloff = std::max(a.falloff, b.falloff);
  if (wide.axis == narrow.axis || wide.spread >= std::numbers::pi) return {wide.axis, wide.spread, falloff};
  const double between = std::acos(std::clamp(wide.axis.dot(narrow.axis), -1.0, 1.0));
  if (between + narrow.spread <= wide.spread) return {wide.axis, wide.spread, falloff};
  const double spread = (wide.spread + between + narrow.spread) / 2;
  if (spread >= std::numbers::pi) return {wide.axis, std::numbers::pi, falloff};
  return {turned(wide.axis, narrow.axis, spread - wide.spread), spread, falloff};
}

double measure(const EmissionCone& cone) {
  const double rim = std::min(cone.spread + cone.falloff, std::numbers::pi);
  const double cosine = std::cos(cone.spread);
  const double sine = std::sin(cone.spread);
  // 2 pi times the integrals of sin t up to the spread, and of cos(t - spread) sin t from there to the rim.
  return 2 * std::numbers::pi * (1 - cosine) +
         std::numbers::pi / 2 * (2 * (rim - cone.spread) * sine + cosine - std::cos(cone.spread - 2 * rim));
}

LightBounds union_of(const LightBounds& a, const LightBounds& b) {
  Imath::Box3d box = a.box;
  box.extendBy(b.box);
  // At the center of lights spread uniformly through a ball, the mean of 1/d^2 is 3/r^2. A smaller bound, as
  // here, gives more weight to the nearer half of a node. The second moment of
  // tests/transport/light_sampler_test.cpp is 1.75 at r^2/2 and 1.46 at r^2/8; smaller values do not improve
  // it.
  constexpr double kNearest = 0.35;
  const double radius = box.size().length() / 2;
  return {box,
          radius,
          kNearest * radius,
          union_of(a.cone, b.cone),
          a.facing + b.facing,
          a.all_sides + b.all_sides,
          a.at_infinity};
}

LightImportance::LightImportance(const LightBounds& bounds, double scale, double min_distance)
    : center_(bounds.box.center()),
      radius2_(static_cast<float>(bounds.radius * bounds.radius)),
      nearest2_(static_cast<float>(std::pow(std::max(bounds.nearest, min_distance), 2))),
      axis_(bounds.cone.axis),
      cos_spread_(static_cast<float>(std::cos(bounds.cone.spread))),
      cos_falloff_(static_cast<float>(std::cos(bounds.cone.falloff))),
      facing_(static_cast<float>(bounds.facing * scale)),
      all_sides_(static_cast<float>(bounds.all_sides * scale)),
      at_infinity_(bounds.at_infinity),
      ambient_(bounds.ambient) {}

// I max(0, cos e) max(0, cos r) / max(d^2, nearest^2) with the strength I and the distance d of the sphere's
// center. The angle e is that with the emission's axis, less its spread and the sphere's half angle. The
// angle r is that with the receiver's normal, less the half angle.
float LightImportance::irradiance(const LightSampleContext& context) const {
  if (ambient_ && context.glossy) return 0;
  const float strength = context.side ? facing_ : all_sides_;
  if (at_infinity_)
    return context.side ? strength * std::max(0.0F, cos_excess(context.side->dot(axis_), cos_spread_))
                        : strength;
  const Imath::V3f to_center = center_ - context.point;
  const float distance2 = to_center.length2();
  const float nearness = strength / std::max(distance2, nearest2_);
  if (!(distance2 > radius2_)) return nearness;
  const Imath::V3f towards = to_center * (1 / std::sqrt(distance2));
  const float cos_half_angle = std::sqrt(1 - radius2_ / distance2);  // half angle of the sphere
  const float emitted = cos_excess(cos_excess(-axis_.dot(towards), cos_spread_), cos_half_angle);
  if (emitted < cos_falloff_) return 0;
  const float received = context.side ? cos_excess(context.side->dot(towards), cos_half_angle) : 1;
  return nearness * std::max(0.0F, emitted) * std::max(0.0F, received);
}

void append_tree(std::vector<LightLeaf> leaves, const LightScale& scale, std::vector<LightNode>& nodes) {
  Builder(scale, nodes).append(leaves, 0);
}

}  // namespace abbe
