// A colour chart as a scene object: a grid of patches with measured reflectances in a dark surround.
#include <utility>

#include "description/shape.h"
#include "spectral/chart.h"

namespace abbe::description {
namespace {

constexpr std::size_t kChartColumns = 6;
constexpr double kPatchFraction = 0.86;  // Fraction of a cell's edge, as on a ColorChecker Classic.
constexpr double kSurround = 0.035;      // Reflectance of the black plastic of a ColorChecker.

// The rectangle of all cells, upright as seen by the reader: `corner` is at the lower left.
struct Grid {
  Quad quad;
  std::size_t rows;

  // Position of line number `i` (two lines per cell) along an edge of `cells` cells, as a fraction of the
  // edge.
  [[nodiscard]] static double line(std::size_t i, std::size_t cells) {
    const auto n = static_cast<double>(cells);
    if (i == 0) return 0;
    if (i == 2 * cells + 1) return 1;
    const double margin = (1 - kPatchFraction) / 2;
    const std::size_t cell = (i - 1) / 2;
    return (static_cast<double>(cell) + (i % 2 == 1 ? margin : 1 - margin)) / n;
  }
  [[nodiscard]] Imath::V3d at(std::size_t i, std::size_t j) const {
    return quad.corner + quad.edge_u * line(i, kChartColumns) + quad.edge_v * line(j, rows);
  }
};

// Line numbers of the lower left corner of a patch. Patches count row by row from the top left.
std::pair<std::size_t, std::size_t> lines_of(std::size_t patch, std::size_t rows) {
  return {2 * (patch % kChartColumns) + 1, 2 * (rows - 1 - patch / kChartColumns) + 1};
}

Quad patch_quad(const Grid& grid, std::size_t patch) {
  const auto [i, j] = lines_of(patch, grid.rows);
  const Imath::V3d corner = grid.at(i, j);
  return {corner, grid.at(i + 1, j) - corner, grid.at(i, j + 1) - corner};
}

// Mesh of the area between the patches, including cells of the last row without a patch.
Mesh surround_mesh(const Grid& grid, std::size_t patches) {
  const std::size_t columns = 2 * kChartColumns + 2;
  const std::size_t rows = 2 * grid.rows + 2;
  std::vector<bool> taken(columns * rows, false);
  for (std::size_t patch = 0; patch < patches; ++patch) {
    const auto [i, j] = lines_of(patch, grid.rows);
    taken[j * columns + i] = true;
  }
  Mesh mesh;
  for (std::size_t j = 0; j < rows; ++j)
    for (std::size_t i = 0; i < columns; ++i) mesh.vertices.push_back(grid.at(i, j));
  for (std::size_t j = 0; j + 1 < rows; ++j)
    for (std::size_t i = 0; i + 1 < columns; ++i) {
      if (taken[j * columns + i]) continue;
      const auto a = static_cast<std::uint32_t>(j * columns + i);
      const auto above = static_cast<std::uint32_t>(a + columns);
      mesh.triangles.push_back({a, a + 1, above});
      mesh.triangles.push_back({above + 1, above, a + 1});
    }
  return mesh;
}

// Index of a new diffuse material; the name need not be unique.
std::uint32_t add_diffuse(const std::string& name, Curve reflectance, Scene& scene) {
  scene.materials.push_back({name, DiffuseMaterial{std::move(reflectance)}});
  return static_cast<std::uint32_t>(scene.materials.size() - 1);
}

// Index of the material of a patch, which all charts of the same table use.
std::uint32_t patch_material(const std::string& table, const Patch& patch, LoadContext& context,
                             Scene& scene) {
  const std::string name = table + ":" + patch.name;
  const auto known = context.materials.find(name);
  if (known != context.materials.end()) return known->second;
  return context.materials[name] = add_diffuse(name, patch.reflectance, scene);
}

}  // namespace

std::vector<NamedShape> build(const spec::Chart& spec, const std::string& name, LoadContext& context,
                              Scene& scene) {
  const auto surround = spec.surround ? build(*spec.surround, kReflectanceUse, context) : Curve(kSurround);
  const SourcePosition& where = spec.reflectances.where;
  const auto file = context.table(spec.reflectances.value, where);
  const auto chart =
      file ? load_chart(*file, where, context.diagnostics, kReflectanceUse, context.coverage.needed)
           : std::nullopt;
  if (!chart || !surround) return {};
  const Imath::V3d edge_u = spec.edge_u * context.unit_m;
  const Imath::V3d edge_v = spec.edge_v * context.unit_m;
  if (edge_u.cross(edge_v).length() == 0) {
    context.diagnostics.error(spec.where, "edge_u and edge_v are parallel: a chart of zero area");
    return {};
  }
  const std::size_t patches = chart->patches.size();
  const Grid grid{{spec.corner * context.unit_m, edge_u, edge_v},
                  (patches + kChartColumns - 1) / kChartColumns};
  std::vector<NamedShape> parts;
  for (std::size_t i = 0; i < patches; ++i) {
    const Patch& patch = chart->patches[i];
    parts.push_back(
        {name + "/" + patch.name, patch_quad(grid, i), patch_material(*file, patch, context, scene)});
  }
  parts.push_back(
      {name + "/surround", surround_mesh(grid, patches), add_diffuse(name + "/surround", *surround, scene)});
  return parts;
}

}  // namespace abbe::description
