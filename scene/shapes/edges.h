#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/shapes/shape.h"

namespace abbe {

/// A triangle at one of its edges. Vertices are named by the first one at the same place.
struct EdgeSide {
  std::uint32_t high;      ///< The end of the edge with the higher number.
  std::uint32_t opposite;  ///< The triangle's third vertex.
  std::uint32_t triangle;
  bool forward;  ///< The triangle winds from the lower end to the higher.
};

/// The edges of a mesh's triangles; its slivers, which join edges too, have the numbers after the last
/// triangle.
class EdgeTable {
 public:
  explicit EdgeTable(const Mesh& mesh);

  /// Calls `visit` with the sides of each edge, those with the same third vertex beside each other.
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
      first_;  // of the sides of edges by their lower end, and of what is beyond the last
  std::vector<EdgeSide> sides_;
};

}  // namespace abbe
