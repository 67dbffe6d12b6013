#pragma once

#include <cstdint>
#include <vector>

#include <ImathVec.h>

#include "scene/lights/light.h"
#include "scene/lights/model.h"

namespace abbe {

/// Cone that contains both, with the larger of their falloffs. [Conty2018]
[[nodiscard]] EmissionCone union_of(const EmissionCone& a, const EmissionCone& b);

/// Measure of a cone [sr]: the solid angle of its spread, plus that of the falloff weighted by its cosine.
/// [Conty2018]
[[nodiscard]] double measure(const EmissionCone& cone);

/// Bounds of all lights of both, which must be nearby in both or at infinity in both. The result is not
/// ambient.
[[nodiscard]] LightBounds union_of(const LightBounds& a, const LightBounds& b);

/// Bounds of lights, prepared for evaluation at path vertices.
class LightImportance {
 public:
  /// Multiplies the strengths of `bounds` by `scale`. `min_distance` [m] > 0 is a lower bound for `nearest`,
  /// so that the irradiance at the position of a light is finite.
  LightImportance(const LightBounds& bounds, double scale, double min_distance);

  /// Irradiance bound for a vertex: the unoccluded irradiance from the most favourable direction and
  /// orientation within the lights' sphere, at the distance of its center. [Conty2018] Its unit is that of
  /// the scaled strengths, per m^2 for nearby lights. Not negative; 0 if no emission can arrive, and for
  /// ambient light at glossy vertices.
  [[nodiscard]] float irradiance(const LightSampleContext& context) const;

 private:
  Imath::V3f center_;
  float radius2_;
  float nearest2_;
  Imath::V3f axis_;
  float cos_spread_;
  float cos_falloff_;
  float facing_;
  float all_sides_;
  bool at_infinity_;
  bool ambient_;
};

/// Light by its index in the scene, with its bounds.
struct LightLeaf {
  std::uint32_t light;  ///< Index into `Scene::lights`.
  LightBounds bounds;
};

/// Node of a binary tree over lights.
struct LightNode {
  LightImportance importance;
  std::uint32_t lights;  ///< Number of lights below the node; 1 for a leaf.
  /// Index into `Scene::lights` for a leaf; otherwise the index of the second child in the list of nodes. The
  /// first child follows the node.
  std::uint32_t next;
};

/// Parameters that convert bounds into the importance of a node.
struct LightScale {
  double strength;      ///< Factor of all strengths.
  double min_distance;  ///< `min_distance` of `LightImportance` [m], greater than 0.
};

/// Appends a tree over `leaves` to `nodes`, its root first. There must be a leaf, and all must be nearby or
/// all at infinity. Each node is split along its longest axis where the sum of both halves' costs is least.
/// The cost of a half is its strength times its squared radius times the measure of its emission cone
/// [Conty2018]. Every leaf is at most 64 levels below the root, so 64 bits encode the path to it.
void append_tree(std::vector<LightLeaf> leaves, const LightScale& scale, std::vector<LightNode>& nodes);

}  // namespace abbe
