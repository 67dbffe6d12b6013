#include <cmath>

#include <fmt/format.h>

#include "validation/bench/soak/drawing.h"

namespace abbe::soak {
namespace {

using Point = std::array<double, 3>;

// Corners and faces of [-x, x] x [-y, y] x [-z, z]. The triangles are counter-clockwise viewed from outside.
Json box_mesh(const Point& half) {
  Json vertices = Json::array();
  for (const double x : {-half[0], half[0]})
    for (const double y : {-half[1], half[1]})
      for (const double z : {-half[2], half[2]}) vertices.push_back({x, y, z});
  const Json triangles = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                          {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
  return {{"vertices", vertices}, {"triangles", triangles}};
}

// Octahedron with its corners on the three axes.
Json octahedron(const Point& half) {
  Json vertices = Json::array();
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const double sign : {1, -1}) {
      Point corner{0, 0, 0};
      corner[axis] = sign * half[axis];
      vertices.push_back(corner);
    }
  Json triangles = Json::array();
  for (int x : {0, 1})
    for (int y : {2, 3})
      for (int z : {4, 5}) {
        const bool outward = (x + y + z) % 2 == 0;
        triangles.push_back({x, outward ? y : z, outward ? z : y});
      }
  return {{"vertices", vertices}, {"triangles", triangles}};
}

// Random triangles. Some are thin; some have a common edge or coincide.
Json rubble(Random& random, double half) {
  Json vertices = Json::array();
  const int count = integer(random, 3, 30);
  for (int i = 0; i < count; ++i) {
    const double flatness = decades(random, 1e-6, 1);
    vertices.push_back({half * uniform(random, -1, 1), half * uniform(random, -1, 1),
                        half * flatness * uniform(random, -1, 1)});
  }
  Json triangles = Json::array();
  for (int i = 0; i + 2 < count; ++i) triangles.push_back({i, i + 1, i + 2});
  if (chance(random, 0.5)) triangles.push_back(triangles.front());
  return {{"vertices", vertices}, {"triangles", triangles}};
}

Json rotation(Drawing& drawing) {
  const double angle =
      chance(drawing, 0.3) ? one_of(drawing, {0.0, 90.0, 45.0, 180.0}) : uniform(drawing, -360, 360);
  return {{"axis", draw_direction(drawing)}, {"deg", angle}};
}

Json draw_target(Drawing& drawing) {
  drawing.targets.push_back(draw_position(drawing, 0.8));
  return drawing.targets.back();
}

// Transforms a shape of half size `half` around its own origin to a random position in the box.
Json placed(Drawing& drawing, Json shape) {
  Json transform;
  if (chance(drawing, 0.6)) transform["rotate"] = rotation(drawing);
  transform["translate"] = draw_target(drawing);
  shape["transform"] = transform;
  return shape;
}

Json solid_mesh(Drawing& drawing, double half) {
  const Point sides{half, half * decades(drawing, 0.05, 1), half * decades(drawing, 0.05, 1)};
  return {{"mesh", chance(drawing, 0.5) ? box_mesh(sides) : octahedron(sides)}};
}

Json mesh_file(Drawing& drawing, double half) {
  Json shape{{"mesh", draw_mesh_file(drawing)}};
  shape["transform"] = {{"scale", half}, {"rotate", rotation(drawing)}, {"translate", draw_target(drawing)}};
  return shape;
}

Json sphere_shape(Drawing& drawing, double half) {
  return {{"sphere", {{"center", draw_target(drawing)}, {"radius", half}}}};
}

Json flat_shape(Drawing& drawing, double half) {
  if (chance(drawing, 0.5))
    return {
        {"disc", {{"center", draw_target(drawing)}, {"normal", draw_direction(drawing)}, {"radius", half}}}};
  return placed(drawing,
                {{"quad",
                  {{"corner", {0, 0, 0}},
                   {"edge_u", {half, 0, 0}},
                   {"edge_v", {half * uniform(drawing, -1, 1), half * decades(drawing, 1e-3, 1), 0}}}}});
}

Json prism(Drawing& drawing, double half) {
  return placed(drawing, {{"prism",
                           {{"apex_deg", uniform(drawing, 5, 170)},
                            {"side", half},
                            {"length", half * decades(drawing, 0.05, 5)}}}});
}

Json wall_material(Drawing& drawing) {
  if (chance(drawing, 0.15)) return {{"mirror", {{"reflectance", uniform(drawing, 0, 0.99)}}}};
  if (chance(drawing, 0.15)) return {{"conductor", {{"ior", "Al_Rakic"}, {"roughness", 0.2}}}};
  return {{"diffuse", {{"reflectance", one_of(drawing, {0.0, 0.5, 0.95, 1.0})}}}};
}

// Walls of a closed box: six quads that overlap at their common edges, one mesh, or a sphere.
void add_walls(Drawing& drawing) {
  drawing.scene["materials"]["wall"] = wall_material(drawing);
  Json& shapes = drawing.scene["shapes"];
  const double s = drawing.size;
  const Point& m = drawing.center;
  const int kind = integer(drawing, 0, 2);
  if (kind == 0) {
    shapes.push_back({{"sphere", {{"center", m}, {"radius", s * std::sqrt(3)}}}, {"material", "wall"}});
  } else if (kind == 1) {
    shapes.push_back(
        {{"mesh", box_mesh({s, s, s})}, {"material", "wall"}, {"transform", {{"translate", m}}}});
  } else {
    const double half_edge = s * (1 + decades(drawing, 1e-4, 1));
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const double sign : {-1, 1}) {
        Point corner{m[0] - half_edge, m[1] - half_edge, m[2] - half_edge};
        corner[axis] = m[axis] + sign * s;
        Point u{0, 0, 0};
        Point v{0, 0, 0};
        u[(axis + 1) % 3] = v[(axis + 2) % 3] = 2 * half_edge;
        shapes.push_back(
            {{"quad", {{"corner", corner}, {"edge_u", u}, {"edge_v", v}}}, {"material", "wall"}});
      }
  }
}

void add_ground(Drawing& drawing) {
  const double s = drawing.size * decades(drawing, 1, 100);
  const Point& m = drawing.center;
  drawing.scene["shapes"].push_back({{"quad",
                                      {{"corner", {m[0] - s, m[1] - s, m[2] - drawing.size}},
                                       {"edge_u", {2 * s, 0, 0}},
                                       {"edge_v", {0, 2 * s, 0}}}},
                                     {"material", drawing.materials.front().name}});
}

// Nested media: concentric spheres, or adjacent boxes of which some coincide.
void add_nested_media(Drawing& drawing) {
  std::vector<DrawnMaterial> solids;
  for (const DrawnMaterial& drawn : drawing.materials)
    if (drawn.has_interior && !drawn.needs_surface_uv) solids.push_back(drawn);
  if (solids.empty()) return;
  Json& shapes = drawing.scene["shapes"];
  const Json center = draw_position(drawing, 0.5);
  double half = drawing.size * decades(drawing, 1e-2, 0.7);
  const bool boxes = chance(drawing, 0.5);
  Point shift{0, 0, 0};
  for (int i = integer(drawing, 2, 6); i > 0; --i) {
    Point at{};
    for (std::size_t axis = 0; axis < 3; ++axis) at[axis] = center[axis].get<double>() + shift[axis];
    Json shape = boxes ? Json{{"mesh", box_mesh({half, half, half})}, {"transform", {{"translate", at}}}}
                       : Json{{"sphere", {{"center", at}, {"radius", half}}}};
    shape["material"] = one_of(drawing, solids).name;
    shapes.push_back(shape);
    if (boxes && chance(drawing, 0.4))
      shift[static_cast<std::size_t>(integer(drawing, 0, 2))] += 2 * half * one_of(drawing, {-1, 1});
    else if (chance(drawing, 0.7))
      half *= chance(drawing, 0.3) ? 1 - decades(drawing, 1e-9, 1e-1) : uniform(drawing, 0.2, 1);
  }
}

Json affine(Drawing& drawing) {
  Json step;
  if (chance(drawing, 0.5))
    step["scale"] = {decades(drawing, 0.1, 3), -decades(drawing, 0.1, 3), decades(drawing, 0.1, 3)};
  else
    step["scale"] = decades(drawing, 0.1, 3);
  step["rotate"] = rotation(drawing);
  Json offset = Json::array();
  for (int axis = 0; axis < 3; ++axis) offset.push_back(0.3 * drawing.size * uniform(drawing, -1, 1));
  step["translate"] = offset;
  // Transforms about the center of the scene leave the shapes inside it.
  Json to_origin = Json::array();
  for (const double x : drawing.center) to_origin.push_back(-x);
  return {{{"translate", to_origin}}, step, {{"translate", drawing.center}}};
}

void add_instances(Drawing& drawing) {
  Json& object = drawing.scene["objects"]["thing"]["shapes"];
  for (int i = integer(drawing, 1, 2); i > 0; --i)
    object.push_back(draw_shape(drawing, one_of(drawing, drawing.materials)));
  for (int i = integer(drawing, 1, 4); i > 0; --i) {
    Json instance{{"instance", {{"of", "thing"}, {"transform", affine(drawing)}}}};
    maybe_animate(drawing, instance);
    drawing.scene["shapes"].push_back(instance);
  }
}

void add_chart(Drawing& drawing) {
  const double s = drawing.size;
  drawing.scene["shapes"].push_back({{"name", "chart"},
                                     {"chart",
                                      {{"reflectances", "colorchecker24_ohta1997"},
                                       {"corner", draw_position(drawing, 0.3)},
                                       {"edge_u", {0.3 * s, 0.1 * s, 0}},
                                       {"edge_v", {-0.05 * s, 0.15 * s, 0.2 * s}}}}});
}

// A ball of a scattering medium around the whole scene, inside the walls of a closed box.
void add_fog(Drawing& drawing) {
  for (const DrawnMaterial& drawn : drawing.materials) {
    if (!drawn.name.starts_with("medium")) continue;
    drawing.scene["shapes"].push_back(
        {{"sphere", {{"center", drawing.center}, {"radius", (drawing.closed ? 1.7 : 4) * drawing.size}}},
         {"material", drawn.name}});
    return;
  }
}

}  // namespace

Json draw_shape(Drawing& drawing, const DrawnMaterial& drawn) {
  const bool large = chance(drawing, 0.7);
  const double half = drawing.size * decades(drawing, large ? 0.05 : drawn.has_interior ? 1e-3 : 1e-4, 1);
  Json shape;
  switch (integer(drawing, 0, 6)) {
    case 0:
      shape = prism(drawing, half);
      break;
    case 1:
      shape =
          drawn.needs_surface_uv ? sphere_shape(drawing, half) : placed(drawing, solid_mesh(drawing, half));
      break;
    case 2:
      shape = drawn.needs_surface_uv ? prism(drawing, half) : mesh_file(drawing, half);
      break;
    case 3:
      shape = drawn.has_interior ? sphere_shape(drawing, half) : flat_shape(drawing, half);
      break;
    case 4:
      shape = drawn.has_interior || drawn.needs_surface_uv
                  ? sphere_shape(drawing, half)
                  : placed(drawing, {{"mesh", rubble(drawing, half)}});
      break;
    default:
      shape = sphere_shape(drawing, half);
  }
  shape["material"] = drawn.name;
  return shape;
}

void draw_shapes(Drawing& drawing) {
  drawing.scene["shapes"] = Json::array();
  if (drawing.closed)
    add_walls(drawing);
  else if (chance(drawing, 0.6))
    add_ground(drawing);
  for (int i = integer(drawing, 1, 7); i > 0; --i) {
    const DrawnMaterial& drawn = one_of(drawing, drawing.materials);
    Json shape = draw_shape(drawing, drawn);
    if (!drawn.has_interior && chance(drawing, 0.15)) {
      shape["emission"] = draw_emission(drawing, "area");
      if (!shape.contains("sphere") && !shape.contains("prism") && chance(drawing, 0.5))
        shape["two_sided"] = true;
    }
    maybe_animate(drawing, shape);
    drawing.scene["shapes"].push_back(shape);
  }
  if (chance(drawing, 0.4)) add_nested_media(drawing);
  if (chance(drawing, 0.3)) add_instances(drawing);
  if (chance(drawing, 0.1)) add_chart(drawing);
  if (chance(drawing, 0.3)) add_fog(drawing);
}

}  // namespace abbe::soak
