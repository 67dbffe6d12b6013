#include "scene/faces.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <variant>

#include <ImathBoxAlgo.h>

namespace abbe {
namespace {

using Imath::Box3d;
using Imath::M44d;
using Imath::V3d;

constexpr std::size_t kRunLength = 64;  // triangles

using BoxesOfMeshes = std::map<const Mesh*, FaceFinder::MeshBoxes>;

const FaceFinder::MeshBoxes& boxes_of(const Mesh& mesh, BoxesOfMeshes& boxes_of_meshes) {
  const auto [at, added] = boxes_of_meshes.try_emplace(&mesh);
  auto& [around, runs] = at->second;
  if (!added) return at->second;
  runs.resize((mesh.triangles.size() + kRunLength - 1) / kRunLength);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (const std::uint32_t vertex : mesh.triangles[i]) runs[i / kRunLength].extendBy(mesh.vertices[vertex]);
  for (const Box3d& run : runs) around.extendBy(run);
  return at->second;
}

// Adds the flat faces of a shape, transformed by a matrix, that intersect the box.
struct FaceCollector {
  const M44d& to_world;
  double handedness;  // of the matrix: -1 if it mirrors, which reverses the winding
  const Box3d& within;
  BoxesOfMeshes& boxes_of_meshes;
  std::vector<Face>& faces;

  void add(std::array<V3d, 4> corners, bool round = false) const {
    Box3d box;
    for (V3d& corner : corners) {
      corner = corner * to_world;
      box.extendBy(corner);
    }
    if (!box.intersects(within)) return;
    const V3d across = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    faces.push_back({corners, box, across.normalized() * handedness, round});
  }
  void operator()(const Mesh& mesh) const {
    const std::vector<Box3d>& runs = boxes_of(mesh, boxes_of_meshes).runs;
    const bool is_identity = to_world == M44d();  // transforming boxes takes most of the time
    for (std::size_t run = 0; run < runs.size(); ++run) {
      if (!(is_identity ? runs[run] : Imath::transform(runs[run], to_world)).intersects(within)) continue;
      const std::size_t end = std::min((run + 1) * kRunLength, mesh.triangles.size());
      for (std::size_t i = run * kRunLength; i < end; ++i) {
        const auto& [a, b, c] = mesh.triangles[i];
        add({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c], mesh.vertices[c]});
      }
    }
  }
  template <typename S>
  void operator()(const S& shape) const {
    if (const std::optional<FlatFace> flat = flat_face(shape)) add(flat->corners, flat->round);
  }
  void operator()(const PlacedShape& placed) const {
    const M44d& at = placed.at->to_world;
    std::visit(FaceCollector{at, std::copysign(1.0, at.determinant()), within, boxes_of_meshes, faces},
               placed.of->shape);
  }
};

}  // namespace

std::vector<Face> FaceFinder::near(const Shape& shape, const Box3d& box) {
  std::vector<Face> faces;
  const M44d unmoved;
  std::visit(FaceCollector{unmoved, 1, box, boxes_of_meshes_, faces}, shape);
  std::sort(faces.begin(), faces.end(),
            [](const Face& a, const Face& b) { return a.box.min.x < b.box.min.x; });
  return faces;
}

Box3d FaceFinder::box_of(const Shape& shape) {
  const auto* mesh = std::get_if<Mesh>(&shape);
  return mesh != nullptr ? boxes_of(*mesh, boxes_of_meshes_).around : bounds(shape);
}

}  // namespace abbe
