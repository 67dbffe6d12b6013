#pragma once

#include <cstdint>
#include <vector>

#include "transport/plan/light_importance.h"

namespace abbe {

/// A light by its index in the scene, and its bounds.
struct LightLeaf {
  std::uint32_t light;
  LightBounds bounds;
};

/// A node of a binary tree over lights.
struct LightNode {
  LightImportance importance;
  std::uint32_t lights;  ///< Below it; 1 is a leaf.
  std::uint32_t next;    ///< Of a leaf the light, else the second child: the first follows the node itself.
};

/// What turns bounds into the importance of a node.
struct LightScale {
  double strength;        ///< What strengths are multiplied by.
  double least_distance;  ///< [m], > 0.
};

/// Appends a tree over `leaves`, all of them near or all at infinity, at least one: each node is split along
/// its longest axis where the products of strength, size and cone of the halves are smallest in sum
/// [Conty2018]. No way from the root to a leaf has more than 64 turns.
void append_tree(std::vector<LightLeaf> leaves, const LightScale& scale, std::vector<LightNode>& nodes);

}  // namespace abbe
