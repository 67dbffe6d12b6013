#include <string>
#include <vector>

#include <fmt/format.h>

#include "description/shape.h"
#include "scene/shapes/solid.h"

namespace abbe::description {
namespace {

using Counts = std::vector<std::pair<std::size_t, const char*>>;

// Text such as "2 open edges, 1 triangle back to back with another". "(s)" in a text marks the plural ending.
std::string counted(const Counts& counts) {
  std::vector<std::string> words;
  for (const auto& [count, what] : counts) {
    if (count == 0) continue;
    std::string named = what;
    const std::size_t plural = named.find("(s)");
    named.replace(plural, 3, count == 1 ? "" : "s");
    words.push_back(fmt::format("{} {}", count, named));
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

// Repairs a mesh around a medium as far as possible, and reports the rest.
void enclose_medium(Mesh& mesh, const std::string& name, const Material& material,
                    const SourcePosition& where, const LoadContext& context) {
  Diagnostics& diagnostics = context.diagnostics;
  const std::string within = fmt::format("{} around medium \"{}\"", name, material.name);
  const SolidReport solid = make_solid(mesh);
  if (solid.repaired())
    diagnostics.warning(where, fmt::format("{}: repaired: {}", within,
                                           counted({{solid.repeated, "repeated triangle(s)"},
                                                    {solid.rewound, "triangle(s) wound against the rest"},
                                                    {solid.inverted, "component(s) facing inward"}})));
  if (!solid.encloses())
    diagnostics.error_if_strict(
        where, fmt::format(
                   "{} is not a closed surface: {}", within,
                   counted({{solid.open_edges, "open edge(s)"},
                            {solid.crowded_edges, "edge(s) of more than two triangles that cannot be paired"},
                            {solid.clashing_edges, "edge(s) with opposite windings"},
                            {solid.back_to_back, "triangle(s) back to back with another"},
                            {solid.buried, "component(s) facing outward inside the medium"}})));
  if (!mesh.normals.empty() && !is_boundary(material))
    diagnostics.error_if_strict(
        where, fmt::format("{}: vertex normals are ignored, because light is refracted at the flat triangles",
                           within));
  mesh.normals = {};
}

}  // namespace

void prepare_for_medium(Mesh& mesh, const std::string& name, const Material& material,
                        const SourcePosition& where, const LoadContext& context) {
  if (encloses_medium(material))
    enclose_medium(mesh, name, material, where, context);
  else
    mesh.slivers = {};  // Only closed meshes need their zero-area triangles.
}

}  // namespace abbe::description
