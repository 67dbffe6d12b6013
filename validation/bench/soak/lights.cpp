#include <algorithm>

#include "validation/bench/soak/drawing.h"

namespace abbe::soak {
namespace {

// A spectrum with some power in the visible range.
Json spectrum(Drawing& drawing, double max_value) {
  Random& random = drawing.random;
  Json curve{{"sum", {draw_curve(drawing, max_value), {{"band", {520, 580}}, {"value", 0.01 * max_value}}}}};
  if (chance(random, 0.2)) curve = max_value;
  if (chance(random, 0.2))
    curve = {{"lines",
              {{{"nm", 546.1}, {"width_nm", decades(random, 1e-3, 1)}, {"power", max_value}},
               {{"nm", uniform(random, 400, 700)},
                {"width_nm", decades(random, 1e-3, 10)},
                {"power", max_value}}}}};
  if (drawing.closed) curve = {{"product", {curve, {{"band", {300, kMaxInside_nm}}}}}};
  return curve;
}

Json relative_emission(Drawing& drawing) {
  Random& random = drawing.random;
  if (drawing.closed) return {{"spectrum", spectrum(drawing, 1)}};
  switch (integer(random, 0, 3)) {
    case 0:
      return {{"blackbody_K", decades(random, 1500, 1e6)}};
    case 1:
      return {{"daylight_K", uniform(random, 4000, 25000)}};
    case 2:
      return {{"spectrum", spectrum(drawing, 1)}};
    default:
      return {{"illuminant", one_of(random, {"A", "D65", "E", "FL11", "LED-B3"})}};
  }
}

Json unpolarised_emission(Drawing& drawing, const std::string& kind) {
  Random& random = drawing.random;
  // A point or spot light produces the same irradiance at the distance of a scene's size as the others do.
  const double distance = kind == "point" ? drawing.size * drawing.unit_m : 1;
  const double amount = drawing.brightness * decades(random, 1e-3, 1e3) * distance * distance;
  if (chance(random, 0.4)) return {{"spectrum", chance(random, 0.05) ? Json(0) : spectrum(drawing, amount)}};
  Json emission = relative_emission(drawing);
  const bool photometric = chance(random, 0.5);
  if (kind == "area" || kind == "environment")
    emission[photometric ? "luminance" : "radiance"] = amount;
  else if (kind == "point")
    emission[photometric ? "luminous_intensity" : "intensity"] = amount;
  else
    emission[photometric ? "illuminance" : "irradiance"] = amount;
  return emission;
}

}  // namespace

Json draw_emission(Drawing& drawing, const std::string& kind) {
  Random& random = drawing.random;
  Json emission = unpolarised_emission(drawing, kind);
  if (!chance(random, 0.15)) return emission;
  if (chance(random, 0.6))
    emission["polarised"]["axis"] = draw_direction(drawing);
  else
    emission["polarised"]["circular"] = one_of(random, {"left", "right"});
  if (chance(random, 0.5)) emission["polarised"]["degree"] = uniform(random, 0, 1);
  return emission;
}

namespace {

Json area_light(Drawing& drawing) {
  Random& random = drawing.random;
  const double r = drawing.size * decades(random, 1e-5, 0.2);
  Json light;
  switch (integer(random, 0, 2)) {
    case 0:
      light["sphere"] = {{"center", draw_position(drawing, 0.7)}, {"radius", r}};
      break;
    case 1:
      light["disc"] = {
          {"center", draw_position(drawing, 0.7)}, {"normal", draw_direction(drawing)}, {"radius", r}};
      break;
    default:
      light["quad"] = {{"corner", draw_position(drawing, 0.7)},
                       {"edge_u", {0, r, 0}},
                       {"edge_v", {r * decades(random, 1e-3, 1), r * uniform(random, -1, 1), 0}}};
  }
  light["emission"] = draw_emission(drawing, "area");
  maybe_animate(drawing, light);
  if (!light.contains("sphere") && chance(random, 0.5)) light["two_sided"] = true;
  const DrawnMaterial& drawn = one_of(random, drawing.materials);
  if (!drawn.has_interior && chance(random, 0.4)) light["material"] = drawn.name;
  return light;
}

Json point_or_spot_light(Drawing& drawing) {
  Random& random = drawing.random;
  Json light;
  if (chance(random, 0.5))
    light["point"] = {{"at", draw_position(drawing, 0.7)}};
  else
    light["spot"] = {{"at", draw_position(drawing, 0.7)},
                     {"direction", draw_direction(drawing)},
                     {"half_angle_deg", decades(random, 0.1, 180)}};
  light["emission"] = draw_emission(drawing, "point");
  maybe_animate(drawing, light);
  return light;
}

Json distant_light(Drawing& drawing) {
  Random& random = drawing.random;
  Json light;
  if (chance(random, 0.5)) {
    light["directional"] = {{"towards", draw_direction(drawing)}};
    light["emission"] = draw_emission(drawing, "directional");
  } else {
    light["sun"] = {{"towards", draw_direction(drawing)},
                    {"angular_diameter_deg", decades(random, 0.01, 60)}};
    light["emission"] = draw_emission(drawing, "sun");
  }
  return light;
}

Json environment(Drawing& drawing) {
  Json light{{"environment", Json::object()}, {"emission", draw_emission(drawing, "environment")}};
  if (chance(drawing.random, 0.4))
    light["environment"] = {{"image", draw_image(drawing, {"R", "G", "B"}, 0, 1)},
                            {"up", draw_direction(drawing)},
                            {"rotate_deg", uniform(drawing.random, -360, 360)}};
  return light;
}

// Light that must not enter the box.
Json outside_light(Drawing& drawing) {
  const Json emission{
      {"spectrum", {{"band", {kMaxInside_nm + 50, 1100}}, {"value", 1e3 * drawing.brightness}}}};
  if (chance(drawing.random, 0.7)) return {{"environment", Json::object()}, {"emission", emission}};
  return {{"sun", {{"towards", draw_direction(drawing)}, {"angular_diameter_deg", 60}}},
          {"emission", emission}};
}

}  // namespace

void draw_lights(Drawing& drawing) {
  Random& random = drawing.random;
  Json& lights = drawing.scene["lights"];
  lights = Json::array();
  for (int i = integer(random, 1, 3); i > 0; --i) {
    const double kind = uniform(random, 0, 1);
    lights.push_back(kind < 0.5                      ? area_light(drawing)
                     : drawing.closed || kind < 0.75 ? point_or_spot_light(drawing)
                                                     : distant_light(drawing));
  }
  if (drawing.closed)
    lights.push_back(outside_light(drawing));
  else if (chance(random, 0.5))
    lights.push_back(environment(drawing));
}

}  // namespace abbe::soak
