// CGAL's Polygon_mesh_processing also orients and repairs meshes, but its licence would extend to Abbe.
#include "scene/shapes/solid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "scene/shapes/mesh.h"

namespace abbe {
namespace {

/// A triangle at one of its edges. A vertex is identified by the index of the first vertex at its position.
struct EdgeSide {
  std::uint32_t low, high;  ///< Ends of the edge, by index.
  std::uint32_t opposite;   ///< Third vertex of the triangle.
  std::uint32_t triangle;  ///< Index into `Mesh::triangles`, or that size plus an index into `Mesh::slivers`.
  bool forward;            ///< True if the triangle's winding runs from `low` to `high`.
};
/// Sides of the edges of a mesh, in order of the edge and then of the third vertex.
using EdgeSides = std::vector<EdgeSide>;

using Corners = std::array<std::uint32_t, 3>;

// Returns for each vertex the index of the first one at the same position.
std::vector<std::uint32_t> welded(const std::vector<Imath::V3d>& vertices) {
  std::vector<std::uint32_t> order(vertices.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(
      order, {}, [&](std::uint32_t i) { return std::tuple(vertices[i].x, vertices[i].y, vertices[i].z, i); });
  std::vector<std::uint32_t> first(vertices.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool repeats = i > 0 && vertices[order[i]] == vertices[order[i - 1]];
    first[order[i]] = repeats ? first[order[i - 1]] : order[i];
  }
  return first;
}

// Slivers join edges too; their indices follow those of the triangles. A triangle with two corners at one
// position has no edges.
EdgeSides edges_of(const Mesh& mesh) {
  const std::vector<std::uint32_t> first = welded(mesh.vertices);
  EdgeSides sides;
  sides.reserve(3 * (mesh.triangles.size() + mesh.slivers.size()));
  std::uint32_t triangle = 0;
  for (const auto* list : {&mesh.triangles, &mesh.slivers})
    for (const Corners& corners : *list) {
      const Corners at{first[corners[0]], first[corners[1]], first[corners[2]]};
      const bool joins = at[0] != at[1] && at[1] != at[2] && at[2] != at[0];
      for (std::size_t i = 0; joins && i < 3; ++i) {
        const auto [low, high] = std::minmax(at[i], at[(i + 1) % 3]);
        sides.push_back({low, high, at[(i + 2) % 3], triangle, low == at[i]});
      }
      ++triangle;
    }
  std::ranges::sort(sides, {}, [](const EdgeSide& side) {
    return std::tie(side.low, side.high, side.opposite, side.triangle);
  });
  return sides;
}

// Calls `visit` once for each edge with a span of its sides, at least one.
template <typename Visit>
void for_each_edge(const EdgeSides& sides, Visit&& visit) {
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i + 1;
    while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high) ++end;
    visit(std::span<const EdgeSide>(&sides[i], end - i));
    i = end;
  }
}

/// Union-find over triangles. Each triangle winds with or against the first triangle of its set.
class Windings {
 public:
  explicit Windings(std::size_t count) : parent_(count), against_(count, false) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }
  /// The first triangle of the set, and true if `triangle` winds against it.
  std::pair<std::uint32_t, bool> find(std::uint32_t triangle) {
    std::uint32_t first = triangle;
    bool against = false;
    for (; parent_[first] != first; first = parent_[first]) against = against != against_[first];
    const bool found = against;
    while (parent_[triangle] != first) {
      const std::uint32_t next = parent_[triangle];
      const bool step = against_[triangle];
      parent_[triangle] = first;
      against_[triangle] = against;
      against = against != step;
      triangle = next;
    }
    return {first, found};
  }
  /// Merges two sets; `opposed` tells that the two triangles wind against each other.
  void join(std::uint32_t a, std::uint32_t b, bool opposed) {
    const auto [first, a_against] = find(a);
    const auto [other, b_against] = find(b);
    if (first == other) return;
    parent_[other] = first;
    against_[other] = (a_against != b_against) != opposed;
  }

 private:
  std::vector<std::uint32_t> parent_;
  std::vector<std::uint8_t> against_;
};

/// Triangles connected by edges of two triangles, without an open edge.
struct Component {
  std::vector<std::uint32_t> triangles;
  std::vector<std::uint32_t> against = {};  ///< Those that wind against the first one.
  Imath::Box3d box = {};
  double volume = 0;  ///< Negative when it faces inward.
  bool turned = false;
};

/// A mesh whose triangles can be flipped. `turned` records the flipped ones, slivers after the others.
struct Turning {
  Mesh& mesh;
  std::vector<bool> turned;

  explicit Turning(Mesh& m) : mesh(m), turned(m.triangles.size() + m.slivers.size(), false) {}
  void turn(std::uint32_t triangle) {
    turned[triangle] = !turned[triangle];
    const auto swap = [triangle](auto& corners) {
      if (triangle < corners.size()) std::swap(corners[triangle][1], corners[triangle][2]);
    };
    swap(mesh.triangles);
    swap(mesh.coordinates);
    swap(mesh.normals);
  }
};

// Marks triangles with the corners and the winding of an earlier one. A triangle has three edges; it is
// tested at the edge opposite its last corner.
std::vector<bool> repeated_triangles(const Mesh& mesh, const EdgeSides& edges) {
  std::vector<bool> repeated(mesh.triangles.size() + mesh.slivers.size(), false);
  for_each_edge(edges, [&](std::span<const EdgeSide> sides) {
    auto run = sides.begin();
    for (auto side = sides.begin(); side != sides.end(); ++side) {
      if (side->opposite != run->opposite) run = side;
      repeated[side->triangle] =
          repeated[side->triangle] ||
          (side->opposite > side->high &&
           std::any_of(run, side, [&](const EdgeSide& s) { return s.forward == side->forward; }));
    }
  });
  return repeated;
}

// Removes the marked triangles and returns their number.
std::size_t remove_triangles(Mesh& mesh, const std::vector<bool>& marked) {
  const std::size_t before = mesh.triangles.size();
  const auto keep = [&marked](auto& list, std::size_t first) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < list.size(); ++i)
      if (!marked[first + i]) list[count++] = list[i];
    list.resize(count);
  };
  keep(mesh.slivers, before);
  keep(mesh.coordinates, 0);
  keep(mesh.normals, 0);
  keep(mesh.triangles, 0);
  return before - mesh.triangles.size();
}

// Marks the sets that cannot be oriented consistently, by their first triangles. At edges with more than two
// triangles, the windings within a set must cancel.
std::vector<bool> flawed_sets(const EdgeSides& edges, Windings& sets, std::size_t triangles) {
  std::vector<bool> flawed(triangles, false);
  std::vector<std::pair<std::uint32_t, int>> ends;
  for_each_edge(edges, [&](std::span<const EdgeSide> sides) {
    ends.clear();
    for (const EdgeSide& side : sides) {
      const auto [first, against] = sets.find(side.triangle);
      ends.emplace_back(first, side.forward != against ? 1 : -1);
    }
    std::sort(ends.begin(), ends.end());
    for (auto end = ends.begin(); end != ends.end();) {
      const std::uint32_t set = end->first;
      int balance = 0;
      for (; end != ends.end() && end->first == set; ++end) balance += end->second;
      if (balance != 0) flawed[set] = true;
    }
  });
  return flawed;
}

std::vector<Component> closed_components(const EdgeSides& edges, std::uint32_t count) {
  Windings sets(count);
  for_each_edge(edges, [&sets](std::span<const EdgeSide> sides) {
    if (sides.size() == 2)
      sets.join(sides[0].triangle, sides[1].triangle, sides[0].forward == sides[1].forward);
  });
  const std::vector<bool> flawed = flawed_sets(edges, sets, count);
  // index of the component, by the first triangle of its set
  std::vector<std::uint32_t> number(count, count);
  std::vector<Component> found;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto [first, opposed] = sets.find(i);
    if (flawed[first]) continue;
    if (number[first] == count) {
      number[first] = static_cast<std::uint32_t>(found.size());
      found.emplace_back();
    }
    found[number[first]].triangles.push_back(i);
    if (opposed) found[number[first]].against.push_back(i);
  }
  return found;
}

// Flips triangles until each component is consistent. Returns the number of flipped triangles.
std::size_t rewind(const std::vector<Component>& components, Turning& turning) {
  std::size_t rewound = 0;
  for (const Component& component : components) {
    std::vector<std::uint32_t> fewer = component.against;
    if (2 * fewer.size() > component.triangles.size()) {
      fewer.clear();
      std::ranges::set_difference(component.triangles, component.against, std::back_inserter(fewer));
    }
    for (const std::uint32_t triangle : fewer) {
      turning.turn(triangle);
      rewound += triangle < turning.mesh.triangles.size() ? 1 : 0;
    }
  }
  return rewound;
}

void measure(const Mesh& mesh, Component& component) {
  // Slivers, at the end, have no volume.
  while (!component.triangles.empty() && component.triangles.back() >= mesh.triangles.size())
    component.triangles.pop_back();
  for (const std::uint32_t triangle : component.triangles) {
    const auto& [a, b, c] = mesh.triangles[triangle];
    const Imath::V3d& origin = mesh.vertices[mesh.triangles[component.triangles[0]][0]];
    for (const std::uint32_t corner : {a, b, c}) component.box.extendBy(mesh.vertices[corner]);
    component.volume += (mesh.vertices[a] - origin).dot(area_vector(mesh, triangle)) / 3;
  }
}

// Contribution of an edge to the winding number of the projection around p in the xy plane: +1 or -1 if the
// edge crosses the ray from p towards +x. It is evaluated from the lower end, so that the triangles on both
// sides of an edge agree.
int winding_step(const Imath::V3d& from, const Imath::V3d& to, const Imath::V3d& p) {
  if ((from.y <= p.y) == (to.y <= p.y)) return 0;
  const bool up = from.y < to.y;
  const Imath::V3d& low = up ? from : to;
  const Imath::V3d& high = up ? to : from;
  const bool is_right = (high.x - low.x) * (p.y - low.y) > (p.x - low.x) * (high.y - low.y);
  return !is_right ? 0 : up ? 1 : -1;
}

// One point of each component; arbitrary for components of slivers alone.
std::vector<Imath::V3d> points_of(const Mesh& mesh, const std::vector<Component>& components) {
  std::vector<Imath::V3d> points;
  for (const Component& component : components) {
    Imath::V3d& point = points.emplace_back(0);
    if (component.triangles.empty()) continue;
    for (const std::uint32_t corner : mesh.triangles[component.triangles[0]])
      point += mesh.vertices[corner] / 3;
  }
  return points;
}

// Returns for each component the preceding components whose boxes contain its point, in order. Points and
// boxes are swept in order of x.
std::vector<std::vector<std::uint32_t>> boxes_around(const std::vector<Imath::V3d>& points,
                                                     const std::vector<Component>& components) {
  std::vector<std::uint32_t> by_point(components.size());
  std::iota(by_point.begin(), by_point.end(), 0U);
  std::vector<std::uint32_t> by_box = by_point;
  const auto low = [&](std::uint32_t i) { return components[i].box.min.x; };
  std::sort(by_box.begin(), by_box.end(), [&](auto a, auto b) { return low(a) < low(b); });
  std::sort(by_point.begin(), by_point.end(), [&](auto a, auto b) { return points[a].x < points[b].x; });
  std::vector<std::vector<std::uint32_t>> around(components.size());
  std::vector<std::uint32_t> open_boxes;
  auto next = by_box.begin();
  for (const std::uint32_t i : by_point) {
    const Imath::V3d& point = points[i];
    for (; next != by_box.end() && low(*next) <= point.x; ++next) open_boxes.push_back(*next);
    std::erase_if(open_boxes, [&](std::uint32_t box) { return components[box].box.max.x < point.x; });
    for (const std::uint32_t box : open_boxes)
      if (box < i && components[box].box.intersects(point)) around[i].push_back(box);
    std::sort(around[i].begin(), around[i].end());
  }
  return around;
}

// Winding number of a component around a point: 1 inside if it faces outward, -1 inside if it faces inward, 0
// outside. It is computed along the ray from the point towards +z as the number of exits minus that of
// entries.
int winding_number(const Imath::V3d& point, const Mesh& mesh, const Component& component) {
  int windings = 0;
  for (const std::uint32_t triangle : component.triangles) {
    const auto& [first, second, third] = mesh.triangles[triangle];
    const Imath::V3d& a = mesh.vertices[first];
    const Imath::V3d& b = mesh.vertices[second];
    const Imath::V3d& c = mesh.vertices[third];
    const int leaving = winding_step(a, b, point) + winding_step(b, c, point) + winding_step(c, a, point);
    const Imath::V3d normal = (b - a).cross(c - a);
    if (leaving != 0 && (a - point).dot(normal) * normal.z > 0) windings += leaving;
  }
  return windings;
}

// Processes components in order of decreasing volume, because only a larger one can enclose a smaller one.
// The orientation of the inner one depends on that of the outer.
void turn_outward(std::vector<Component>& components, Turning& turning, SolidReport& report) {
  const Mesh& mesh = turning.mesh;
  std::sort(components.begin(), components.end(),
            [](const Component& a, const Component& b) { return std::abs(a.volume) > std::abs(b.volume); });
  const std::vector<Imath::V3d> points = points_of(mesh, components);
  const auto around = boxes_around(points, components);
  for (std::size_t i = 0; i < components.size(); ++i) {
    Component& component = components[i];
    if (component.triangles.empty()) continue;
    int winding = 0;
    bool is_in_turned = false;
    for (const std::uint32_t other : around[i])
      if (const int windings = winding_number(points[i], mesh, components[other]); windings != 0) {
        winding += windings;
        is_in_turned = components[other].turned;
      }
    const bool inward = component.volume < 0;
    component.turned = inward ? winding <= 0 : is_in_turned && winding > 0;
    if (component.turned) ++report.inverted;
    if (!inward && !component.turned && winding > 0) ++report.buried;
    if (component.turned)
      for (const std::uint32_t triangle : component.triangles) turning.turn(triangle);
  }
}

void count_faults(const EdgeSides& edges, const Turning& turning, SolidReport& report) {
  const std::size_t triangles = turning.mesh.triangles.size();
  for_each_edge(edges, [&](std::span<const EdgeSide> sides) {
    const auto forward = std::count_if(sides.begin(), sides.end(), [&](const EdgeSide& side) {
      return side.forward != turning.turned[side.triangle];
    });
    if (sides.size() == 1)
      ++report.open_edges;
    else if (2 * static_cast<std::size_t>(forward) != sides.size())
      ++(sides.size() == 2 ? report.clashing_edges : report.crowded_edges);
    for (std::size_t i = 1; i < sides.size(); ++i)
      if (sides[i].opposite == sides[i - 1].opposite && sides[i].opposite > sides[i].high &&
          std::max(sides[i].triangle, sides[i - 1].triangle) < triangles)
        ++report.back_to_back;
  });
}

}  // namespace

SolidReport make_solid(Mesh& mesh) {
  SolidReport report;
  EdgeSides edges = edges_of(mesh);
  report.repeated = remove_triangles(mesh, repeated_triangles(mesh, edges));
  if (report.repeated > 0) edges = edges_of(mesh);
  Turning turning(mesh);
  std::vector<Component> components =
      closed_components(edges, static_cast<std::uint32_t>(turning.turned.size()));
  report.rewound = rewind(components, turning);
  for (Component& component : components) measure(mesh, component);
  turn_outward(components, turning, report);
  count_faults(edges, turning, report);
  return report;
}

double enclosed_volume(const Mesh& mesh) {
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size() + mesh.slivers.size());
  double largest = 0;
  for (Component& component : closed_components(edges_of(mesh), count)) {
    measure(mesh, component);
    largest = std::max(largest, std::abs(component.volume));
  }
  return largest;
}

}  // namespace abbe
