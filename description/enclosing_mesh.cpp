#include <string>
#include <vector>

#include <fmt/format.h>

#include "description/shape.h"
#include "scene/shapes/solid.h"

namespace abbe::description {
namespace {

using Counts = std::vector<std::pair<std::size_t, const char*>>;

// "2 open edges, 1 triangle back to back with others": what there is of, "(s)" standing for a plural's s.
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

// Puts right what can be of a mesh around matter, and reports the rest.
void enclose_medium(Mesh& mesh, const std::string& name, const Material& material,
                    const SourcePosition& where, const LoadContext& context) {
  Diagnostics& diagnostics = context.diagnostics;
  const std::string within = fmt::format("{} around matter \"{}\"", name, material.name);
  const SolidReport solid = make_solid(mesh);
  if (solid.mended())
    diagnostics.warning(where, fmt::format("{}: put right: {}", within,
                                           counted({{solid.repeated, "repeated triangle(s)"},
                                                    {solid.rewound, "triangle(s) wound against the rest"},
                                                    {solid.inverted, "component(s) facing inward"}})));
  if (!solid.encloses())
    diagnostics.error_if_strict(
        where,
        fmt::format("{} is no closed surface: {}", within,
                    counted({{solid.open_edges, "open edge(s)"},
                             {solid.crowded_edges, "edge(s) of more than two triangles that do not pair off"},
                             {solid.clashing_edges, "edge(s) with opposite windings"},
                             {solid.back_to_back, "triangle(s) back to back with another"},
                             {solid.buried, "component(s) facing outward within its matter"}})));
  if (!mesh.normals.empty() && !is_boundary(material))
    diagnostics.error_if_strict(
        where,
        fmt::format("{}: its vertex normals are ignored: light is refracted by flat triangles", within));
  mesh.normals = {};
}

}  // namespace

void prepare_for_medium(Mesh& mesh, const std::string& name, const Material& material,
                        const SourcePosition& where, const LoadContext& context) {
  if (encloses_medium(material))
    enclose_medium(mesh, name, material, where, context);
  else
    mesh.slivers = {};  // nothing asks for them any more
}

}  // namespace abbe::description
