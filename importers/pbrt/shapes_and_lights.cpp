#include "importers/pbrt/scene_objects.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "description/meshes/mesh_file.h"
#include "importers/pbrt/spectra.h"
#include "importers/shared/materials.h"
#include "importers/shared/scene_importer.h"
#include "scene/shapes/mesh.h"
#include "spectral/colorimetry.h"

namespace abbe::importers::pbrt {
namespace {

using spec::Quantity;
using Surface = decltype(ImportedShape::surface);

const std::vector<std::string> kShapeTypes{"bilinearmesh", "curve",   "cylinder", "disk",
                                           "loopsubdiv",   "plymesh", "sphere",   "trianglemesh"};

std::nullopt_t report_missing(const Directive& directive, std::string_view name) {
  return directive.fail(fmt::format("a shape \"{}\" needs \"{}\"", directive.type, name));
}

std::vector<std::array<double, 3>> points(const Parameters& p) {
  const std::vector<double> numbers = p.numbers("P");
  std::vector<std::array<double, 3>> points;
  for (std::size_t i = 0; i + 2 < numbers.size(); i += 3)
    points.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
  return points;
}

// Indices of the corners of faces with `count` corners each. Without "indices" there is a single face.
// Nothing, after an error, if an index is out of range, or if "indices" is absent and the number of points is
// not `count`.
std::optional<std::vector<std::uint32_t>> indices(const Directive& directive, std::size_t points,
                                                  std::size_t count) {
  std::vector<std::uint32_t> indices;
  if (!directive.parameters.has("indices") && points != count)
    return directive.fail(fmt::format("a shape \"{}\" needs \"indices\" unless it has {} points (got {})",
                                      directive.type, count, points));
  if (!directive.parameters.has("indices")) indices.resize(count);
  std::iota(indices.begin(), indices.end(), 0U);
  for (const double index : directive.parameters.numbers("indices")) {
    if (!(index >= 0 && index < static_cast<double>(points)))
      return directive.fail(
          fmt::format("an index is out of range (got {}, allowed [0, {}])", index, points - 1));
    indices.push_back(static_cast<std::uint32_t>(index));
  }
  const std::size_t excess = indices.size() % count;
  if (excess > 0)
    directive.note(
        fmt::format("indices after the last complete face of a shape \"{}\" are dropped", directive.type));
  indices.resize(indices.size() - excess);
  return indices;
}

void add_coordinates(const Directive& directive, spec::InlineMesh& mesh) {
  const Parameters& p = directive.parameters;
  const std::vector<double> uv = p.numbers(p.has("st") ? "st" : "uv");
  if (uv.empty()) return;
  if (uv.size() != 2 * mesh.vertices.size())
    return directive.note("texture coordinates whose number differs from that of the points are dropped");
  mesh.uv.emplace();
  for (std::size_t i = 0; i + 1 < uv.size(); i += 2) mesh.uv->value.push_back({uv[i], uv[i + 1]});
}

void note_normals(const Directive& directive) {
  if (directive.parameters.has("N"))
    directive.note("vertex normals in the scene file are not supported: dropped (mesh files may have them)");
  directive.parameters.ignore({"N", "S", "faceIndices"});
}

/// Vertices of a mesh with their texture coordinates, and indices of the corners of its faces.
struct Faces {
  spec::InlineMesh mesh{};
  std::vector<std::uint32_t> corners{};
};

// Faces with `count` corners each. Nothing after an error.
std::optional<Faces> faces_of(const Directive& directive, std::size_t count) {
  Faces faces;
  faces.mesh.where = directive.where;
  faces.mesh.vertices = points(directive.parameters);
  if (faces.mesh.vertices.empty()) return report_missing(directive, "P");
  auto corners = indices(directive, faces.mesh.vertices.size(), count);
  if (!corners) return std::nullopt;
  faces.corners = *std::move(corners);
  add_coordinates(directive, faces.mesh);
  note_normals(directive);
  return faces;
}

std::optional<Surface> triangle_mesh(const Directive& directive) {
  auto faces = faces_of(directive, 3);
  if (!faces) return std::nullopt;
  auto& [mesh, corners] = *faces;
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
    mesh.triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
  return std::move(mesh);
}

bool is_parallelogram(const Imath::V3d& p00, const Imath::V3d& p10, const Imath::V3d& p01,
                      const Imath::V3d& p11) {
  return (p00 + p11 - p10 - p01).length() <= 1e-6 * (p11 - p00).length();
}

bool has_plain_coordinates(const spec::InlineMesh& mesh, const std::vector<std::uint32_t>& corners) {
  constexpr std::array<std::array<double, 2>, 4> kPlain{{{0, 0}, {1, 0}, {0, 1}, {1, 1}}};
  if (!mesh.uv) return true;
  return std::ranges::equal(corners, kPlain, {}, [&](std::uint32_t i) { return mesh.uv->value[i]; });
}

// Bilinear patches. A single parallelogram with default coordinates stays a quad; other patches become
// triangles.
std::optional<Surface> bilinear_mesh(const Directive& directive) {
  auto faces = faces_of(directive, 4);
  if (!faces) return std::nullopt;
  auto& [mesh, corners] = *faces;
  const auto at = [&vertices = mesh.vertices, &indices = corners](std::size_t i) {
    const auto& v = vertices[indices[i]];
    return Imath::V3d(v[0], v[1], v[2]);
  };
  for (std::size_t i = 0; i + 3 < corners.size(); i += 4) {
    const bool plain = is_parallelogram(at(i), at(i + 1), at(i + 2), at(i + 3));
    if (plain && corners.size() == 4 && has_plain_coordinates(mesh, corners))
      return spec::Quad{at(0), at(1) - at(0), at(2) - at(0), directive.where};
    const Imath::V3d normal = (at(i + 1) - at(i)).cross(at(i + 2) - at(i));
    if (std::abs(normal.normalized().dot(at(i + 3) - at(i))) > 1e-6 * (at(i + 3) - at(i)).length())
      directive.note("a curved patch is replaced by two triangles");
    mesh.triangles.push_back({corners[i], corners[i + 1], corners[i + 3]});
    mesh.triangles.push_back({corners[i], corners[i + 3], corners[i + 2]});
  }
  return std::move(mesh);
}

std::optional<Surface> ply_mesh(const Directive& directive, ImportState& state) {
  const Parameter* name = directive.parameters.find("filename", {"string"});
  if (name == nullptr) return report_missing(directive, "filename");
  const auto path = state.folder / name->texts.front();
  if (!state.importer.check_file(path, name->where)) return std::nullopt;
  // Read once to report its errors at this position.
  if (!load_mesh_file(path, FileMaterials::ignored, name->where, state.importer.diagnostics,
                      FileCoordinates::ignored, state.importer.inputs))
    return std::nullopt;
  directive.parameters.ignore({"edgelength"});
  return MeshFileSurface{path};
}

Surface note_tessellated(Surface surface, const Directive& directive) {
  directive.note(fmt::format("a curved \"{}\" is replaced by triangles", directive.type));
  return surface;
}

std::optional<Surface> sphere(const Directive& directive) {
  const Parameters& p = directive.parameters;
  const double radius = p.number("radius", 1);
  const double low = p.number("zmin", -radius);
  const double high = p.number("zmax", radius);
  const double phi = p.number("phimax", 360);
  if (low <= -radius && high >= radius && phi >= 360) return spec::Sphere{{0, 0, 0}, radius};
  return note_tessellated(swept_sphere(radius, std::min(low, high), std::max(low, high), phi), directive);
}

std::optional<Surface> disk(const Directive& directive) {
  const Parameters& p = directive.parameters;
  const double height = p.number("height", 0);
  const double radius = p.number("radius", 1);
  const double inner = p.number("innerradius", 0);
  const double phi = p.number("phimax", 360);
  if (inner == 0 && phi >= 360) return spec::Disc{{0, 0, height}, {0, 0, 1}, radius};
  return note_tessellated(swept({{radius, height}, {inner, height}}, phi), directive);
}

std::optional<Surface> cylinder(const Directive& directive) {
  const Parameters& p = directive.parameters;
  const double radius = p.number("radius", 1);
  const double low = p.number("zmin", -1);
  const double high = p.number("zmax", 1);
  const double phi = p.number("phimax", 360);
  if (low < high && phi >= 360)
    return spec::Cylinder{{0, 0, low}, {0, 0, high}, radius, false, directive.where};
  return note_tessellated(swept({{radius, low}, {radius, high}}, phi), directive);
}

std::optional<Surface> surface_of(const Directive& directive, ImportState& state) {
  const std::string& type = directive.type;
  if (type == "trianglemesh") return triangle_mesh(directive);
  if (type == "bilinearmesh") return bilinear_mesh(directive);
  if (type == "plymesh") return ply_mesh(directive, state);
  if (type == "sphere") return sphere(directive);
  if (type == "disk") return disk(directive);
  if (type == "cylinder") return cylinder(directive);
  if (!state.importer.is_known("shape", type, kShapeTypes, directive.where)) return std::nullopt;
  directive.note(fmt::format("a shape \"{}\" is not supported: dropped", type));
  directive.parameters.ignore(
      {"P", "N", "indices", "levels", "type", "width", "width0", "width1", "basis", "degree"});
  return std::nullopt;
}

// Adds the vertex normals "N" to the corners, if there is one for each vertex.
void add_corner_normals(const Parameters& p, Mesh& mesh) {
  const std::vector<double> normals = p.numbers("N");
  if (normals.size() != 3 * mesh.vertices.size()) return;
  const auto at = [&normals](std::uint32_t i) {
    return Imath::V3f(Imath::V3d(normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]));
  };
  for (const auto& [a, b, c] : mesh.triangles) mesh.normals.push_back({at(a), at(b), at(c)});
}

// Triangles of a surface in object space with their normals, two for a parallelogram; empty for curved
// surfaces. Errors of files have been reported before.
Mesh unplaced_triangles(const ImportedShape& shape, const Parameters& p, ImportState& state) {
  Mesh mesh;
  if (const auto* inline_mesh = std::get_if<spec::InlineMesh>(&shape.surface)) {
    for (const auto& [x, y, z] : inline_mesh->vertices) mesh.vertices.emplace_back(x, y, z);
    mesh.triangles = inline_mesh->triangles;
    add_corner_normals(p, mesh);
  }
  if (const auto* quad = std::get_if<spec::Quad>(&shape.surface)) {
    const auto& [corner, u, v, where] = *quad;
    mesh = {{corner, corner + u, corner + v, corner + u + v}, {{0, 1, 3}, {0, 3, 2}}};
    add_corner_normals(p, mesh);
  }
  if (const auto* mesh_file = std::get_if<MeshFileSurface>(&shape.surface)) {
    Diagnostics ignored;
    auto file = load_mesh_file(mesh_file->file, FileMaterials::ignored, shape.where, ignored,
                               FileCoordinates::ignored, state.importer.inputs);
    if (file && !file->submeshes.empty()) mesh = std::move(file->submeshes.front().mesh);
  }
  return mesh;
}

// Areas of the faces that are separate lights in pbrt: each triangle of a mesh, or each patch, which is two
// triangles here. Any other shape is one face with area 1, even if triangles replace it.
std::vector<double> emitting_faces(const Imath::M44d& to_world, Mesh mesh, const std::string& type) {
  const bool patches = type == "bilinearmesh";
  if (!patches && type != "trianglemesh" && type != "plymesh") return {1};
  for (Imath::V3d& vertex : mesh.vertices) vertex *= to_world;
  std::vector<double> areas;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    if (patches && i % 2 == 1)
      areas.back() += area_vector(mesh, i).length();
    else
      areas.push_back(area_vector(mesh, i).length());
  std::erase(areas, 0);
  return areas.empty() ? std::vector<double>{1} : areas;
}

const std::vector<std::string> kLightTypes{"distant", "goniometric", "infinite",
                                           "point",   "projection",  "spot"};
const LinearRgb kWhite{1, 1, 1};

// Emission spectrum of a light. pbrt normalises it to unit luminance and multiplies by "scale".
ImportedLightSpectrum light_spectrum(const Directive& light, std::string_view name, ImportState& state) {
  const double scale = light.parameters.number("scale", 1);
  return light_spectrum_of(spectrum(light.parameters, name, kWhite, state), scale, light.where,
                           state.importer);
}

// Scales the emission to a photometric quantity that the parameter `name` requests, such as lumens or lux.
// `factor` converts it to the quantity of `emitted`.
void rescale(const Directive& light, std::string_view name, double factor, ImportedLightSpectrum& emitted) {
  const double requested = light.parameters.number(name, 0);
  if (requested > 0 && emitted.photometric) *emitted.photometric *= requested * factor;
}

// The emission of a surface with the area light `light`: its luminance, or its luminous flux if the light has
// a "power", which pbrt gives to each face. If their areas differ, the total is spread evenly, which is
// noted: in pbrt such faces differ in radiance.
spec::Emission area_emission(const Directive& light, const Directive& shape, const Imath::M44d& to_world,
                             const Mesh& mesh, ImportState& state) {
  state.importer.is_known("area light", light.type, {"diffuse"}, light.where);
  if (light.parameters.has("power") && shape.type == "plymesh")
    shape.note(
        "\"power\" applies to each face of a \"plymesh\": a quad, one face in pbrt, counts "
        "as two triangles in Abbe");
  ImportedLightSpectrum emitted = light_spectrum(light, "L", state);
  const double power = light.parameters.number("power", 0);
  if (!(power > 0) || !emitted.photometric) return emission_of<Quantity::luminance>(emitted);
  const std::vector<double> faces = emitting_faces(to_world, mesh, shape.type);
  *emitted.photometric *= power * static_cast<double>(faces.size());
  constexpr double kSameArea = 1e-5;
  const auto [min_area, max_area] = std::ranges::minmax(faces);
  if (max_area - min_area > kSameArea * max_area)
    light.note(
        "\"power\" of pbrt applies to each face, so that faces of different areas differ in "
        "radiance: Abbe spreads the power evenly");
  return emission_of<Quantity::luminous_flux>(emitted);
}

void add_point(const Directive& light, const Imath::M44d& m, ImportState& state) {
  ImportedLightSpectrum emitted = light_spectrum(light, "I", state);
  rescale(light, "power", 1 / (4 * std::numbers::pi), emitted);
  const Imath::V3d at = light.parameters.point("from", {0, 0, 0}) * m;
  append_light<spec::PointLightSource, Quantity::luminous_intensity>({at}, emitted, light.where,
                                                                     state.importer);
}

void add_spot(const Directive& light, const Imath::M44d& m, ImportState& state) {
  const Parameters& p = light.parameters;
  ImportedLightSpectrum emitted = light_spectrum(light, "I", state);
  const double outer = p.number("coneangle", 30);
  const double inner = outer - p.number("conedeltaangle", 5);
  const double half_angle = hard_cone(inner, outer, Falloff::smooth_cosine, light.where, state.importer);
  const double solid_angle = 2 * std::numbers::pi * (1 - std::cos(half_angle * std::numbers::pi / 180));
  rescale(light, "power", 1 / solid_angle, emitted);
  const Imath::V3d from = p.point("from", {0, 0, 0}) * m;
  const Imath::V3d to = p.point("to", {0, 0, 1}) * m;
  append_light<spec::SpotLightSource, Quantity::luminous_intensity>({from, to - from, half_angle}, emitted,
                                                                    light.where, state.importer);
}

void add_distant(const Directive& light, const Imath::M44d& m, ImportState& state) {
  ImportedLightSpectrum emitted = light_spectrum(light, "L", state);
  rescale(light, "illuminance", 1, emitted);
  const Imath::V3d from = light.parameters.point("from", {0, 0, 0}) * m;
  const Imath::V3d to = light.parameters.point("to", {0, 0, 1}) * m;
  append_light<spec::DirectionalLightSource, Quantity::illuminance>({from - to, {}}, emitted, light.where,
                                                                    state.importer);
}

// Emission spectrum of the mean of an environment image. Its pixels have equal solid angles, so the mean is
// that of the uniform environment. It is normalised if the light requests an illuminance. Nothing, after an
// error or a note, without a usable image.
std::optional<ImportedLightSpectrum> mean_light_spectrum(const Directive& light, const Parameter& file,
                                                         ImportState& state) {
  SceneImporter& importer = state.importer;
  auto colour = mean_colour(state.folder / file.texts.front(), file.where, importer);
  if (!colour) return std::nullopt;
  const double max_value = *std::ranges::max_element(*colour);
  if (!(max_value > 0)) {
    light.note("an environment image is black: dropped");
    return std::nullopt;
  }
  light.note(
      "the equal-area layout of an environment image is not supported: replaced by a uniform "
      "environment of the mean colour");
  for (double& value : *colour) value /= max_value;
  const double scale = light.parameters.number("scale", 1);
  ImportedLightSpectrum emitted = light_spectrum_of(*colour, scale * max_value, light.where, importer);
  if (light.parameters.number("illuminance", 0) > 0) emitted.photometric = kLuminousEfficacy * scale;
  return emitted;
}

void add_infinite(const Directive& light, ImportState& state) {
  const Parameter* file = light.parameters.find("filename", {"string"});
  std::optional<ImportedLightSpectrum> emitted =
      file ? mean_light_spectrum(light, *file, state) : std::optional(light_spectrum(light, "L", state));
  if (!emitted) return;
  rescale(light, "illuminance", 1 / std::numbers::pi, *emitted);
  light.parameters.ignore({"portal"});
  append_light<spec::EnvironmentLightSource, Quantity::luminance>({{}, light.where}, *emitted, light.where,
                                                                  state.importer);
}

}  // namespace

void add_shape(const Directive& directive, const std::optional<Directive>& light, ImportedShape shape,
               ShapeOwner owner, std::vector<spec::Shape>& shapes, ImportState& state) {
  auto surface = surface_of(directive, state);
  directive.parameters.note_unused(fmt::format("shape \"{}\"", directive.type));
  if (!surface) return;
  shape.surface = *std::move(surface);
  shape.where = directive.where;
  if (light && owner == ShapeOwner::object) {
    directive.note("emission inside objects is not supported: dropped");
  } else if (light) {
    const Mesh mesh = unplaced_triangles(shape, directive.parameters, state);
    shape.emission = area_emission(*light, directive, shape.to_world, mesh, state);
    shape.two_sided = light->parameters.boolean("twosided", false);
    orient_by_normals(mesh, shape, state.importer);
    light->parameters.note_unused("area light");
  }
  append_shape(std::move(shape), owner, shapes, state.importer);
}

void add_light(const Directive& light, const Imath::M44d& to_world, ImportState& state) {
  if (light.type == "point") {
    add_point(light, to_world, state);
  } else if (light.type == "spot") {
    add_spot(light, to_world, state);
  } else if (light.type == "distant") {
    add_distant(light, to_world, state);
  } else if (light.type == "infinite") {
    add_infinite(light, state);
  } else if (state.importer.is_known("light", light.type, kLightTypes, light.where)) {
    light.note(fmt::format("a light \"{}\" is not supported: dropped", light.type));
    return;
  }
  light.parameters.note_unused(fmt::format("light \"{}\"", light.type));
}

}  // namespace abbe::importers::pbrt
