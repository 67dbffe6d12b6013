#pragma once

#include <cstdint>
#include <vector>

#include "transport/plan/light_importance.h"

namespace abbe {

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
