#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/shapes/shape.h"

namespace abbe {

/// A triangle at one of its edges. A vertex is identified by the index of the first vertex at its position.
struct EdgeSide {
  std::uint32_t high;      ///< End of the edge with the higher index.
  std::uint32_t opposite;  ///< Third vertex of the triangle.
  std::uint32_t triangle;  ///< Index into `Mesh::triangles`, or that size plus an index into `Mesh::slivers`.
  bool forward;            ///< True if the triangle's winding runs from the lower end to the higher.
};

/// The edges of a mesh's triangles. Slivers join edges too; their indices follow those of the triangles. A
/// triangle with two corners at one position has no edges. The mesh need not outlive it.
class EdgeTable {
 public:
  explicit EdgeTable(const Mesh& mesh);

  /// Calls `visit` once for each edge with a span of its sides, at least one. Sides with the same third
  /// vertex are adjacent.
  template <typename Visit>
  void for_each(Visit&& visit) const {
    for (std::size_t low = 0; low + 1 < first_.size(); ++low)
      for (std::size_t i = first_[low]; i < first_[low + 1];) {
        std::size_t end = i + 1;
        while (end < first_[low + 1] && sides_[end].high == sides_[i].high) ++end;
        visit(std::span<const EdgeSide>(&sides_[i], end - i));
        i = end;
      }
  }

 private:
  std::vector<std::size_t>
      // first side of each edge by its lower end, and an end marker
      first_;
  std::vector<EdgeSide> sides_;
};

}  // namespace abbe
