#include "scene/shapes/edges.h"

#include <array>
#include <bit>
#include <limits>
#include <tuple>

namespace abbe {
namespace {

using Corners = std::array<std::uint32_t, 3>;

std::size_t hash(const Imath::V3d& v) {
  std::uint64_t mixed = 0;
  for (const double x : {v.x, v.y, v.z}) {
    mixed = (mixed ^ std::bit_cast<std::uint64_t>(x + 0.0)) * 0x9E3779B97F4A7C15U;  // maps -0 to 0
    mixed ^= mixed >> 32;
  }
  return mixed;
}

// Returns for each vertex the index of the first one at the same position.
std::vector<std::uint32_t> welded(const std::vector<Imath::V3d>& vertices) {
  constexpr std::uint32_t kFree = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> table(std::bit_ceil(2 * vertices.size() + 1), kFree);
  std::vector<std::uint32_t> first(vertices.size());
  for (std::uint32_t i = 0; i < vertices.size(); ++i) {
    std::size_t at = hash(vertices[i]) & (table.size() - 1);
    while (table[at] != kFree && vertices[table[at]] != vertices[i]) at = (at + 1) & (table.size() - 1);
    if (table[at] == kFree) table[at] = i;
    first[i] = table[at];
  }
  return first;
}

template <typename Visit>
void for_each_side(const Mesh& mesh, const std::vector<std::uint32_t>& first, Visit&& visit) {
  std::uint32_t triangle = 0;
  for (const auto* list : {&mesh.triangles, &mesh.slivers})
    for (const Corners& corners : *list) {
      const Corners at{first[corners[0]], first[corners[1]], first[corners[2]]};
      const bool joins = at[0] != at[1] && at[1] != at[2] && at[2] != at[0];
      for (std::size_t i = 0; joins && i < 3; ++i) {
        const std::uint32_t from = at[i];
        const std::uint32_t to = at[(i + 1) % 3];
        visit(std::min(from, to), EdgeSide{std::max(from, to), at[(i + 2) % 3], triangle, from < to});
      }
      ++triangle;
    }
}

}  // namespace

EdgeTable::EdgeTable(const Mesh& mesh) : first_(mesh.vertices.size() + 1, 0) {
  const std::vector<std::uint32_t> first = welded(mesh.vertices);
  for_each_side(mesh, first, [&](std::uint32_t low, const EdgeSide&) { ++first_[low]; });
  std::size_t total = 0;
  for (std::size_t& end : first_) end = total += end;
  sides_.resize(total);
  for_each_side(mesh, first, [&](std::uint32_t low, const EdgeSide& side) { sides_[--first_[low]] = side; });
  for (std::size_t low = 0; low + 1 < first_.size(); ++low)
    std::sort(&sides_[0] + first_[low], &sides_[0] + first_[low + 1],
              [](const EdgeSide& a, const EdgeSide& b) {
                return std::tie(a.high, a.opposite, a.triangle) < std::tie(b.high, b.opposite, b.triangle);
              });
}

}  // namespace abbe
