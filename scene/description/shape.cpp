#include <cmath>
#include <numbers>
#include <utility>

#include <ImathMatrix.h>
#include <fmt/format.h>

#include "scene/description/pieces.h"
#include "scene/shapes/ply.h"

namespace abbe::description {
namespace {

constexpr Range kScale{0, 1e9, true, false};

/// A similarity: rotation, uniform scale and translation, as a matrix for row vectors.
struct Placement {
  Imath::M44d matrix;
  double scale = 1;
};

// One step; scale, then rotation, then translation, when it has several.
void read_step(const JsonValue& json, Placement& placement, const Reading& reading) {
  ObjectReader reader(json, reading.diagnostics);
  if (const auto factor = reader.number("scale", kScale)) {
    placement.matrix = placement.matrix * Imath::M44d().setScale(*factor);
    placement.scale *= *factor;
  }
  if (const JsonValue* rotation = reader.find("rotate")) {
    ObjectReader inner(*rotation, reading.diagnostics);
    const auto axis = read_direction(inner, "axis", reading);
    const auto angle = inner.require_number("deg", kValue);
    inner.finish();
    if (axis && angle)
      placement.matrix =
          placement.matrix * Imath::M44d().setAxisAngle(*axis, *angle * std::numbers::pi / 180);
  }
  if (reader.find("translate")) {
    const auto by = read_point(reader, "translate", reading);
    if (by) placement.matrix = placement.matrix * Imath::M44d().setTranslation(*by);
  }
  reader.finish();
}

Placement read_transform(const JsonValue& json, const Reading& reading) {
  Placement placement;
  if (const auto* steps = std::get_if<JsonValue::Array>(&json.value)) {
    for (const JsonValue& step : *steps) read_step(step, placement, reading);
  } else {
    read_step(json, placement, reading);
  }
  return placement;
}

Imath::V3d moved_direction(const Imath::V3d& v, const Placement& by) {
  Imath::V3d result;
  by.matrix.multDirMatrix(v, result);
  return result;
}
void move(Mesh& mesh, const Placement& by) {
  for (Imath::V3d& vertex : mesh.vertices) vertex *= by.matrix;
}
void move(Sphere& sphere, const Placement& by) {
  sphere.center *= by.matrix;
  sphere.radius *= by.scale;
}
void move(Disc& disc, const Placement& by) {
  disc.center *= by.matrix;
  disc.normal = moved_direction(disc.normal, by).normalized();
  disc.radius *= by.scale;
}
void move(Quad& quad, const Placement& by) {
  quad.corner *= by.matrix;
  quad.edge_u = moved_direction(quad.edge_u, by);
  quad.edge_v = moved_direction(quad.edge_v, by);
}

template <typename T, std::size_t N>
std::optional<std::vector<std::array<T, N>>> read_rows(ObjectReader& reader, std::string_view key,
                                                       Range allowed, const Reading& reading) {
  const JsonValue* json = reader.require(key);
  if (!json) return std::nullopt;
  const JsonValue::Array* list = read_array(*json, "rows", 1, reading);
  if (!list) return std::nullopt;
  std::vector<std::array<T, N>> rows;
  for (const JsonValue& entry : *list) {
    const auto numbers = read_numbers(entry, N, allowed, reading.diagnostics);
    if (!numbers) return std::nullopt;
    std::array<T, N>& row = rows.emplace_back();
    for (std::size_t i = 0; i < N; ++i) {
      row[i] = static_cast<T>((*numbers)[i]);
      if (static_cast<double>(row[i]) == (*numbers)[i]) continue;
      reading.diagnostics.error(entry.where, fmt::format("expected an integer (got {})", (*numbers)[i]));
      return std::nullopt;
    }
  }
  return rows;
}

std::optional<Mesh> read_inline_mesh(const JsonValue& json, const Reading& reading) {
  ObjectReader reader(json, reading.diagnostics);
  const auto vertices = read_rows<double, 3>(reader, "vertices", kCoordinate, reading);
  const auto triangles = read_rows<std::uint32_t, 3>(reader, "triangles", {0, 4294967295.0}, reading);
  reader.finish();
  if (!vertices || !triangles) return std::nullopt;
  Mesh mesh;
  for (const auto& v : *vertices) mesh.vertices.emplace_back(v[0], v[1], v[2]);
  mesh.triangles = *triangles;
  if (!check_mesh(mesh, json.where, reading.diagnostics)) return std::nullopt;
  return mesh;
}

std::optional<Mesh> read_mesh(const JsonValue& json, Reading& reading) {
  std::optional<Mesh> mesh;
  if (const auto* name = std::get_if<std::string>(&json.value)) {
    const auto path = reading.file(*name, json.where);
    if (path) mesh = load_ply(*path, json.where, reading.diagnostics);
  } else {
    mesh = read_inline_mesh(json, reading);
  }
  if (mesh)
    for (Imath::V3d& vertex : mesh->vertices) vertex *= reading.unit_m;
  return mesh;
}

std::optional<Mesh> read_prism(const JsonValue& json, const Reading& reading) {
  ObjectReader reader(json, reading.diagnostics);
  const auto apex = reader.require_number("apex_deg", {0, 180, true, true});
  const auto side = reader.require_number("side", kLength);
  const auto length = reader.require_number("length", kLength);
  reader.finish();
  if (!apex || !side || !length) return std::nullopt;
  return make_prism(*apex, *side * reading.unit_m, *length * reading.unit_m);
}

std::optional<Shape> read_geometry(ObjectReader& reader, Reading& reading) {
  const auto key = reader.exactly_one({"mesh", "sphere", "disc", "quad", "prism"});
  if (!key) return std::nullopt;
  const JsonValue& json = *reader.find(*key);
  if (*key == "mesh") return read_mesh(json, reading);
  if (*key == "sphere") return read_sphere(json, reading);
  if (*key == "disc") return read_disc(json, reading);
  if (*key == "quad") return read_quad(json, reading);
  return read_prism(json, reading);
}

void read_shape(const JsonValue& json, std::size_t number, Reading& reading, Scene& scene) {
  ObjectReader reader(json, reading.diagnostics);
  std::string name = reader.string("name").value_or(fmt::format("shape {}", number));
  std::optional<Shape> shape = read_geometry(reader, reading);
  const JsonValue* material_name = reader.require("material");
  const auto material = material_name ? find_material(*material_name, reading, scene) : std::nullopt;
  const JsonValue* transform = reader.find("transform");
  const JsonValue* emission = reader.find("emission");
  const bool two_sided = reader.boolean_or("two_sided", false);
  reader.finish();
  Placement placement;
  if (transform) placement = read_transform(*transform, reading);
  if (!shape || !material) return;
  std::visit([&](auto& s) { move(s, placement); }, *shape);
  scene.shapes.push_back({std::move(name), std::move(*shape), *material});
  if (emission)
    add_area_light(*emission, two_sided, static_cast<std::uint32_t>(scene.shapes.size() - 1), reading, scene);
}

}  // namespace

std::optional<Imath::V3d> read_point(ObjectReader& reader, std::string_view key, const Reading& reading) {
  const auto v = reader.require_numbers(key, 3, kCoordinate);
  if (!v) return std::nullopt;
  return Imath::V3d((*v)[0], (*v)[1], (*v)[2]) * reading.unit_m;
}

std::optional<Imath::V3d> read_direction(ObjectReader& reader, std::string_view key, const Reading& reading) {
  const auto v = reader.require_numbers(key, 3, kCoordinate);
  if (!v) return std::nullopt;
  const Imath::V3d direction((*v)[0], (*v)[1], (*v)[2]);
  if (direction.length() > 0) return direction.normalized();
  reading.diagnostics.error(reader.find(key)->where, "a direction must not be zero (got [0, 0, 0])");
  return std::nullopt;
}

std::optional<Sphere> read_sphere(const JsonValue& json, const Reading& reading) {
  ObjectReader reader(json, reading.diagnostics);
  const auto center = read_point(reader, "center", reading);
  const auto radius = reader.require_number("radius", kLength);
  reader.finish();
  if (!center || !radius) return std::nullopt;
  return Sphere{*center, *radius * reading.unit_m};
}

std::optional<Disc> read_disc(const JsonValue& json, const Reading& reading) {
  ObjectReader reader(json, reading.diagnostics);
  const auto center = read_point(reader, "center", reading);
  const auto normal = read_direction(reader, "normal", reading);
  const auto radius = reader.require_number("radius", kLength);
  reader.finish();
  if (!center || !normal || !radius) return std::nullopt;
  return Disc{*center, *normal, *radius * reading.unit_m};
}

std::optional<Quad> read_quad(const JsonValue& json, const Reading& reading) {
  ObjectReader reader(json, reading.diagnostics);
  const auto corner = read_point(reader, "corner", reading);
  const auto edge_u = read_point(reader, "edge_u", reading);
  const auto edge_v = read_point(reader, "edge_v", reading);
  reader.finish();
  if (!corner || !edge_u || !edge_v) return std::nullopt;
  if (edge_u->cross(*edge_v).length() > 0) return Quad{*corner, *edge_u, *edge_v};
  reading.diagnostics.error(json.where,
                            "edge_u and edge_v are parallel: a quad of zero area (got 0, allowed (0, inf))",
                            ErrorCode::input);
  return std::nullopt;
}

void read_shapes(const JsonValue& json, Reading& reading, Scene& scene) {
  const JsonValue::Array* list = read_array(json, "shapes", 0, reading);
  if (!list) return;
  for (std::size_t i = 0; i < list->size(); ++i) read_shape((*list)[i], i, reading, scene);
}

}  // namespace abbe::description
