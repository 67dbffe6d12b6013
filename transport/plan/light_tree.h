#pragma once

#include <cstdint>
#include <vector>

#include "transport/plan/light_importance.h"

namespace abbe {

/// Light by its index in the scene, with its bounds.
struct LightLeaf {
  std::uint32_t light;
  LightBounds bounds;
};

/// Node of a binary tree over lights.
struct LightNode {
  LightImportance importance;
  std::uint32_t lights;  ///< Number of lights below the node; 1 for a leaf.
  /// Light of a leaf; otherwise the index of the second child. The first child follows the node.
  std::uint32_t next;
};

/// Parameters that convert bounds into the importance of a node.
struct LightScale {
  double strength;      ///< Factor of all strengths.
  double min_distance;  ///< [m], greater than 0.
};

/// Appends a tree over `leaves`, at least one, which must all be nearby or all at infinity. Each node is
/// split along its longest axis at the smallest sum of strength, size and cone measure of the halves
/// [Conty2018]. Every leaf has at most 64 turns.
void append_tree(std::vector<LightLeaf> leaves, const LightScale& scale, std::vector<LightNode>& nodes);

}  // namespace abbe
