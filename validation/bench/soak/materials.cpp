#include <algorithm>
#include <numbers>

#include <fmt/format.h>

#include "validation/bench/soak/drawing.h"

namespace abbe::soak {
namespace {

// Largest k of coating layers, and of dielectrics and panes. The latter must be clear: at normal incidence, k
// changes their reflectance by at most k^2/(n + 1)^2.
constexpr double kMaxLayerK = 10;
constexpr double kMaxClearK = 1e-2;

Json dielectric_index(Random& random, double max_k) {
  const int kind = integer(random, 0, 7);
  if (kind == 0) return one_of(random, {1.0, 1.0000001, 1.000001, 1.001, 1.5, 2.417, 4.0});
  if (kind == 1) return decades(random, 0.05, 20);
  if (kind == 2) return {{"n", decades(random, 0.3, 4)}, {"k", decades(random, 1e-12, max_k)}};
  return one_of(random, {"N-BK7", "N-SF11", "N-SF66", "F2", "water", "ice_warren2008", "hikari/F2"});
}

Json metal_index(Random& random) {
  if (chance(random, 0.3))
    return {{"n", chance(random, 0.2) ? 0 : decades(random, 1e-3, 100)},
            {"k", chance(random, 0.2) ? 0 : decades(random, 1e-3, 100)}};
  return one_of(random, {"Ag_Johnson", "Au_Johnson", "Al_Rakic", "Cu_Babar", "Cr_Johnson", "Si_Green-2008"});
}

Json layers(Random& random) {
  Json all = Json::array();
  for (int i = integer(random, 1, 3); i > 0; --i) {
    Json layer{{"ior", chance(random, 0.8) ? dielectric_index(random, kMaxLayerK) : Json("Ti_Palm")},
               {"thickness_nm", decades(random, 1e-2, 1e5)}};
    if (chance(random, 0.3))
      all.push_back(
          {{"repeat", integer(random, 1, 12)}, {"layers", {layer, {{"ior", 1.38}, {"thickness_nm", 99.6}}}}});
    else
      all.push_back(layer);
  }
  return all;
}

double alpha(Random& random) {
  return chance(random, 0.1) ? one_of(random, {0.0, 1e-3, 1.0}) : decades(random, 1e-4, 1);
}

// Roughness, isotropic or one value per direction.
Json roughness(Random& random, bool& varies) {
  if (chance(random, 0.6))
    return {{"alpha", alpha(random)}, {"distribution", one_of(random, {"ggx", "beckmann"})}};
  varies = true;
  const double along = decades(random, 2e-3, 1);
  return {along, std::clamp(along * decades(random, 0.06, 16), 2e-3, 1.0)};
}

// Coefficient per metre, grey or coloured. Optical depths across the box range from negligible to opaque.
Json coefficient(Drawing& drawing, double max_depth) {
  const double one = decades(drawing, 1e-8, max_depth) / (2 * drawing.size * drawing.unit_m);
  if (chance(drawing, 0.2)) return 0;
  return chance(drawing, 0.5) ? Json(one) : draw_curve(drawing, one);
}

Json phase(Random& random) {
  if (chance(random, 0.4)) return one_of(random, {"isotropic", "rayleigh"});
  return {{"henyey_greenstein", chance(random, 0.3) ? one_of(random, {-0.9999, 0.0, 0.999, 0.9999})
                                                    : uniform(random, -0.95, 0.95)}};
}

constexpr double kMaxScatteringDepth = 30;  // optical depth; paths in deeper media take too long
constexpr double kMaxAbsorptionDepth = 1e6;

// The absorption coefficient of a clear medium is 4 pi k/wavelength; the longest wavelength is 1.1 um.
Json clear_absorption(Drawing& drawing) {
  constexpr double kMax_per_m = 4 * std::numbers::pi * kMaxClearK / 1.1e-6;
  return coefficient(drawing, std::min(kMaxAbsorptionDepth, kMax_per_m * 2 * drawing.size * drawing.unit_m));
}

Json dielectric(Drawing& drawing, DrawnMaterial& drawn) {
  Json glass{{"ior", dielectric_index(drawing, kMaxClearK)}};
  if (glass["ior"].is_number() && chance(drawing, 0.4)) glass["absorption_per_m"] = clear_absorption(drawing);
  if (chance(drawing, 0.3)) {
    glass["scattering_per_m"] = coefficient(drawing, kMaxScatteringDepth);
    glass["phase"] = phase(drawing);
  }
  if (chance(drawing, 0.2))
    glass["coating"] = layers(drawing);
  else if (chance(drawing, 0.4))
    glass["roughness"] = roughness(drawing, drawn.needs_surface_uv);
  return glass;
}

Json medium(Drawing& drawing) {
  Json fog{{"absorption_per_m", coefficient(drawing, kMaxAbsorptionDepth)},
           {"scattering_per_m", coefficient(drawing, kMaxScatteringDepth)},
           {"phase", phase(drawing)}};
  if (chance(drawing, 0.3)) {
    Json to = draw_position(drawing, 0.2);
    Json from = to;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      from[axis] = from[axis].get<double>() - drawing.size * decades(drawing, 0.01, 1);
      to[axis] = to[axis].get<double>() + drawing.size * decades(drawing, 0.01, 1);
    }
    fog["grid"] = {{"densities", draw_densities(drawing)}, {"from", from}, {"to", to}};
  }
  return fog;
}

Json conductor(Random& random, DrawnMaterial& drawn) {
  Json metal{{"ior", metal_index(random)}};
  if (chance(random, 0.2))
    metal["coating"] = layers(random);
  else if (chance(random, 0.6))
    metal["roughness"] = roughness(random, drawn.needs_surface_uv);
  return metal;
}

Json thin_glass(Drawing& drawing) {
  Json pane{{"ior", decades(drawing, 1, 4)}, {"thickness", drawing.size * decades(drawing, 1e-6, 1e-1)}};
  if (chance(drawing, 0.5)) pane["absorption_per_m"] = clear_absorption(drawing);
  return pane;
}

Json principled(Drawing& drawing, DrawnMaterial& drawn) {
  Json paint{{"base_color", draw_reflectance(drawing, drawn.needs_surface_uv)}};
  for (const char* key : {"metallic", "roughness", "specular", "sheen", "clearcoat", "clearcoat_gloss"})
    if (chance(drawing, 0.6))
      paint[key] = chance(drawing, 0.2) ? one_of(drawing, {0.0, 1.0}) : uniform(drawing, 0, 1);
  return paint;
}

// Thin elements transmit light without deflection and change its polarisation.
Json thin_element(Drawing& drawing, const std::string& name) {
  Json element = Json::object();
  if (chance(drawing, 0.5)) element["transmittance"] = draw_curve(drawing, 1);
  if (name == "depolariser") return element;
  if (chance(drawing, 0.5)) element["angle_deg"] = uniform(drawing, -360, 360);
  if (name == "polariser") {
    if (chance(drawing, 0.5)) element["extinction_ratio"] = decades(drawing, 1, 1e9);
  } else if (chance(drawing, 0.5)) {
    element["retardance_deg"] = chance(drawing, 0.3) ? 90 : uniform(drawing, -720, 720);
  } else {
    element["birefringence"] = decades(drawing, 1e-9, 1);
    element["thickness"] = drawing.size * decades(drawing, 1e-9, 1e-3);
  }
  return element;
}

// Models with a reflectance and at most one more parameter.
Json reflectance_model(Drawing& drawing, DrawnMaterial& drawn, const std::string& model) {
  Json surface{{"reflectance", draw_reflectance(drawing, drawn.needs_surface_uv)}};
  if (model == "oren_nayar") surface["sigma_deg"] = uniform(drawing, 0, 90);
  if (model == "coated_diffuse") surface["ior"] = decades(drawing, 1, 3);
  if (model == "cosine_power" || model == "phong" || model == "retroreflector")
    surface["exponent"] = chance(drawing, 0.2) ? 0 : decades(drawing, 0.1, 1e4);
  if (model == "cosine_power" && chance(drawing, 0.5)) surface["reciprocal"] = true;
  return surface;
}

// Components are the materials drawn before that have no interior.
Json mixture(Drawing& drawing, DrawnMaterial& drawn) {
  Json parts = Json::array();
  for (const DrawnMaterial& other : drawing.materials) {
    if (!other.can_be_mixed || parts.size() >= 3) continue;
    parts.push_back({{"material", other.name}, {"weight", draw_curve(drawing, 1.0 / 3)}});
    drawn.needs_surface_uv |= other.needs_surface_uv;
  }
  return parts;
}

Json model(Drawing& drawing, DrawnMaterial& drawn, const std::string& name) {
  if (name == "dielectric") return dielectric(drawing, drawn);
  if (name == "medium") return medium(drawing);
  if (name == "conductor") return conductor(drawing, drawn);
  if (name == "film") return {{"layers", layers(drawing)}};
  if (name == "thin_glass") return thin_glass(drawing);
  if (name == "polariser" || name == "wave_plate" || name == "depolariser") {
    drawn.needs_surface_uv = name != "depolariser";
    return thin_element(drawing, name);
  }
  if (name == "principled") return principled(drawing, drawn);
  if (name == "mixture") return mixture(drawing, drawn);
  if (name == "schlick" && chance(drawing, 0.5)) return {{"ior", metal_index(drawing)}};
  return reflectance_model(drawing, drawn, name);
}

void add_relief(Drawing& drawing, Json& material, DrawnMaterial& drawn) {
  drawn.needs_surface_uv = true;
  if (chance(drawing, 0.5))
    material["normal_map"] = {{"image", draw_image(drawing, {"R", "G", "B"}, 0.51, 1)}};
  else
    material["bump_map"] = {{"image", draw_image(drawing, {"Y"}, -1, 1)},
                            {"height", drawing.size * decades(drawing, 1e-6, 1e-1)}};
}

void add(Drawing& drawing, const std::string& name) {
  DrawnMaterial drawn{fmt::format("{}{}", name, drawing.materials.size())};
  drawn.has_interior = name == "dielectric" || name == "medium";
  const bool has_axis = name == "polariser" || name == "wave_plate";
  drawn.can_be_mixed = !drawn.has_interior && !has_axis && name != "film" && name != "mixture";
  Json material;
  material[name] = model(drawing, drawn, name);
  if (drawn.has_interior && chance(drawing, 0.5)) material["priority"] = integer(drawing, -2, 2);
  if (name != "medium" && drawing.materials.size() > 0 && chance(drawing, 0.15)) {
    add_relief(drawing, material, drawn);
    drawn.can_be_mixed = false;
  }
  drawing.scene["materials"][drawn.name] = material;
  drawing.materials.push_back(drawn);
}

}  // namespace

void draw_materials(Drawing& drawing) {
  add(drawing, "diffuse");  // available as a component of mixtures
  for (int i = integer(drawing, 1, 6); i > 0; --i)
    add(drawing,
        one_of(drawing,
               {"diffuse",    "dielectric", "dielectric", "dielectric",   "conductor",      "conductor",
                "medium",     "film",       "mirror",     "oren_nayar",   "coated_diffuse", "thin_glass",
                "principled", "mixture",    "schlick",    "cosine_power", "phong",          "retroreflector",
                "polariser",  "wave_plate", "depolariser"}));
}

}  // namespace abbe::soak
