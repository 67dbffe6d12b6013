#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "scene/shapes/mesh.h"

namespace abbe::test {

/// Twelve triangles that face outward; the last four are perpendicular to z.
inline Mesh box(const Imath::V3d& low, const Imath::V3d& high) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.emplace_back((i & 1 ? high : low).x, (i & 2 ? high : low).y, (i & 4 ? high : low).z);
  mesh.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  return mesh;
}

/// The mesh with inverted orientation.
inline Mesh inside_out(Mesh mesh) {
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

inline Mesh joined(Mesh first, const Mesh& second) {
  const auto base = static_cast<std::uint32_t>(first.vertices.size());
  first.vertices.insert(first.vertices.end(), second.vertices.begin(), second.vertices.end());
  for (const auto& [a, b, c] : second.triangles) first.triangles.push_back({a + base, b + base, c + base});
  return first;
}

/// The mesh with separate corners for every triangle, as at seams of texture coordinates or normals.
inline Mesh torn(const Mesh& mesh) {
  Mesh apart;
  for (const auto& triangle : mesh.triangles) {
    const auto base = static_cast<std::uint32_t>(apart.vertices.size());
    for (const std::uint32_t corner : triangle) apart.vertices.push_back(mesh.vertices[corner]);
    apart.triangles.push_back({base, base + 1, base + 2});
  }
  return apart;
}

inline double volume(const Mesh& mesh) {
  double sum = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    sum += mesh.vertices[mesh.triangles[i][0]].dot(area_vector(mesh, i)) / 3;
  return sum;
}

/// The value of "mesh" in a scene file.
inline std::string inline_mesh(const Mesh& mesh) {
  std::string vertices;
  for (const auto& v : mesh.vertices)
    vertices += fmt::format("{}[{}, {}, {}]", vertices.empty() ? "" : ", ", v.x, v.y, v.z);
  std::string triangles;
  for (const auto& [a, b, c] : mesh.triangles)
    triangles += fmt::format("{}[{}, {}, {}]", triangles.empty() ? "" : ", ", a, b, c);
  return fmt::format(R"({{"vertices": [{}], "triangles": [{}]}})", vertices, triangles);
}

/// The unit sphere as an icosahedron subdivided `times` times, with the sphere's normals if `smooth`.
inline Mesh icosphere(int times, bool smooth) {
  const double golden = (1 + std::sqrt(5.0)) / 2;
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const double one : {-1.0, 1.0})
      for (const double far : {-golden, golden}) {
        Imath::V3d corner(0);
        corner[axis] = one;
        corner[(axis + 1) % 3] = far;
        mesh.vertices.push_back(corner.normalized());
      }
  const double side = 2 / std::sqrt(1 + golden * golden);
  const auto near = [&](std::uint32_t a, std::uint32_t b) {
    return (mesh.vertices[a] - mesh.vertices[b]).length() < 1.1 * side;
  };
  for (std::uint32_t a = 0; a < 12; ++a)
    for (std::uint32_t b = a + 1; b < 12; ++b)
      for (std::uint32_t c = b + 1; c < 12; ++c) {
        if (!near(a, b) || !near(b, c) || !near(c, a)) continue;
        const bool outward = mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c])) > 0;
        mesh.triangles.push_back(outward ? std::array{a, b, c} : std::array{a, c, b});
      }
  for (int i = 0; i < times; ++i) {
    std::vector<std::array<std::uint32_t, 3>> finer;
    const auto between = [&](std::uint32_t a, std::uint32_t b) {
      mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]).normalized());
      return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
    };
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::uint32_t ab = between(a, b);
      const std::uint32_t bc = between(b, c);
      const std::uint32_t ca = between(c, a);
      for (const auto& part : {std::array{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
        finer.push_back(part);
    }
    mesh.triangles = std::move(finer);
  }
  const auto normal = [&](std::uint32_t i) { return Imath::V3f(mesh.vertices[i]); };
  for (const auto& [a, b, c] : mesh.triangles)
    if (smooth) mesh.normals.push_back({normal(a), normal(b), normal(c)});
  return mesh;
}

/// The text of an OBJ file, with normals if the mesh has some.
inline std::string obj_text(const Mesh& mesh) {
  std::string text;
  for (const auto& v : mesh.vertices) text += fmt::format("v {} {} {}\n", v.x, v.y, v.z);
  for (const auto& corners : mesh.normals)
    for (const auto& n : corners) text += fmt::format("vn {} {} {}\n", n.x, n.y, n.z);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    text += "f";
    for (std::size_t c = 0; c < 3; ++c)
      text += mesh.normals.empty() ? fmt::format(" {}", mesh.triangles[i].at(c) + 1)
                                   : fmt::format(" {}//{}", mesh.triangles[i].at(c) + 1, 3 * i + c + 1);
    text += "\n";
  }
  return text;
}

}  // namespace abbe::test
