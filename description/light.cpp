#include "description/light.h"

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "description/curve.h"
#include "description/material.h"
#include "description/shape.h"
#include "description/values.h"
#include "scene/shapes/quad.h"
#include "spectral/colorimetry.h"
#include "spectral/library.h"

namespace abbe::description {
namespace {

using Keys = std::span<const std::string_view>;
constexpr std::array<std::string_view, 4> kAreaScales{"radiant_flux_W", "luminous_flux_lm", "radiance",
                                                      "luminance"};
constexpr std::array<std::string_view, 6> kLampScales{"radiant_flux_W", "luminous_flux_lm", "radiance",
                                                      "luminance",      "irradiance",       "illuminance"};
constexpr std::array<std::string_view, 6> kPointScales{
    "radiant_flux_W", "luminous_flux_lm", "intensity", "luminous_intensity", "irradiance", "illuminance"};
constexpr std::array<std::string_view, 2> kEnvironmentScales{"radiance", "luminance"};
constexpr std::array<std::string_view, 2> kBeamScales{"irradiance", "illuminance"};
constexpr std::array<std::string_view, 4> kSunScales{"radiance", "luminance", "irradiance", "illuminance"};

constexpr double kSunDiameter_deg = 0.533;  // of ours, in the mean
constexpr Range kDiameter{0.01, 60};        // degrees: what looks smaller is as good as directional
constexpr Range kHalfAngle{0.1, 180};       // degrees: below, a float's cosine no longer tells cones apart

/// What fixes the strength of a lamp of one kind: the scales it may name, and what a lamp of unit radiance or
/// intensity has of them.
struct LampKind {
  Keys scales;
  double flux;  ///< [m^2 sr] for radiance, [sr] for intensity; 0 without a flux.
  /// Irradiance on its axis at that distance [m], of a surface that faces it: [sr] for radiance, [m^-2] for
  /// intensity.
  std::function<double(double)> irradiance = {};
  bool at_infinity = false;  ///< Irradiates alike everywhere, of a surface that faces it.
};

std::optional<Curve> read_spectrum_curve(std::string_view key, const JsonValue& json, LoadContext& context) {
  if (key == "spectrum" || key == "spectral_flux_W_per_nm")
    return read_curve(json, {"illuminant", kPower}, context);
  if (key != "illuminant") return read_source(key, json, context);
  const std::optional<std::string> name = context.table(json);
  if (!name) return std::nullopt;
  std::optional<NamedCurve> named = load_illuminant(*name, json.where, context.diagnostics);
  if (!named) return std::nullopt;
  return std::move(named->curve);
}

// The same words name the same spectrum, which is read once however many lamps have it.
LampSpectrum* read_spectrum(std::string_view key, const JsonValue& json, LoadContext& context) {
  const std::string words = fmt::format("{} {}", key, to_text(json));
  if (const auto found = context.lamp_spectra.find(words); found != context.lamp_spectra.end())
    return &found->second;
  std::optional<Curve> curve = read_spectrum_curve(key, json, context);
  if (!curve) return nullptr;
  const double power = curve->integral();
  const double luminous = photometric(*curve);
  return &context.lamp_spectra.emplace(words, LampSpectrum{std::move(*curve), power, luminous}).first->second;
}

// A power of two keeps the digits of the first lamp, and all lamps within what a float holds.
ScaledCurve times(LampSpectrum& spectrum, double factor) {
  if (!spectrum.held) {
    spectrum.held_for = factor > 0 ? factor : 1;
    const Curve first = scaled(spectrum.curve, spectrum.held_for);
    (void)std::frexp(first.max(), &spectrum.exponent);
    spectrum.held = std::make_shared<const Curve>(scaled(first, std::ldexp(1.0, -spectrum.exponent)));
  }
  return {spectrum.held, std::ldexp(factor / spectrum.held_for, spectrum.exponent)};
}

/// A quantity that an emission is scaled to, and how much of it a lamp of unit radiance or intensity has.
struct Scale {
  std::string_view name;
  double value;
  double of_unit;
};

// The quantity `name` of the lamp; irradiance and illuminance are had at a distance, but from infinity.
std::optional<Scale> read_scale(ObjectReader& reader, std::string_view name, const LampKind& kind,
                                const LoadContext& context) {
  const auto value = reader.number(name, kPower);
  if (name == "irradiance" || name == "illuminance") {
    if (kind.at_infinity)
      return value ? std::optional(Scale{name, *value, kind.irradiance(0)}) : std::nullopt;
    const auto distance = reader.require_number("distance", kLength);
    if (!value || !distance) return std::nullopt;
    const double of_unit = kind.irradiance(*distance * context.unit_m);
    if (of_unit > 0) return Scale{name, *value, of_unit};
    context.diagnostics.error(reader.where(),
                              fmt::format("lies within the lamp (got a distance of {})", *distance));
    return std::nullopt;
  }
  const bool flux = name == "radiant_flux_W" || name == "luminous_flux_lm";
  return value ? std::optional(Scale{name, *value, flux ? kind.flux : 1}) : std::nullopt;
}

// What `spectrum` is multiplied by to have as much of a quantity as asked for.
std::optional<double> normaliser(const LampSpectrum& spectrum, const Scale& scale,
                                 const SourcePosition& where, const LoadContext& context) {
  const bool luminous = scale.name.starts_with("lumin") || scale.name == "illuminance";
  const double unscaled = (luminous ? spectrum.luminous : spectrum.power) * scale.of_unit;
  if (unscaled > 0) return scale.value / unscaled;
  context.diagnostics.error(where, fmt::format("{} cannot scale this spectrum, which has none", scale.name));
  return std::nullopt;
}

std::optional<ScaledCurve> read_emission(const JsonValue& json, const LampKind& kind, LoadContext& context) {
  ObjectReader reader(json, context.diagnostics);
  const auto key = kind.flux > 0
                       ? reader.exactly_one({"illuminant", "blackbody_K", "daylight_K", "spectrum", "lines",
                                             "spectral_flux_W_per_nm"})
                       : reader.exactly_one({"illuminant", "blackbody_K", "daylight_K", "spectrum", "lines"});
  if (!key) return std::nullopt;
  context.emissions.push_back(json.where);
  LampSpectrum* spectrum = read_spectrum(*key, *reader.find(*key), context);
  std::string_view name;
  std::optional<Scale> scale;
  for (std::string_view candidate : kind.scales) {
    if (!reader.find(candidate)) continue;
    if (!name.empty())
      context.diagnostics.error(json.where,
                                fmt::format("an emission has one scale (got {} and {})", name, candidate));
    name = candidate;
    scale = read_scale(reader, candidate, kind, context);
  }
  reader.finish();
  const bool relative = *key == "illuminant" || *key == "daylight_K";
  if (name.empty() && relative)
    context.diagnostics.error(json.where,
                              fmt::format("{} is a relative spectrum and needs a scale, one of {}", *key,
                                          fmt::join(kind.scales, ", ")));
  if (!spectrum || (name.empty() && relative) || (!name.empty() && !scale)) return std::nullopt;
  if (name.empty()) return times(*spectrum, *key == "spectral_flux_W_per_nm" ? 1 / kind.flux : 1);
  const std::optional<double> factor = normaliser(*spectrum, *scale, json.where, context);
  if (!factor) return std::nullopt;
  return times(*spectrum, *factor);
}

double inverse_square(double distance) {
  return 1 / (distance * distance);
}

/// A light at a point: where it is, and how it spreads.
struct Placed {
  decltype(Light::kind) kind;
  Imath::V3d position{0, 0, 0};
  LampKind lamp;
};

std::optional<Placed> read_point_light(const JsonValue& json, const LoadContext& context) {
  ObjectReader reader(json, context.diagnostics);
  const auto at = read_point(reader, "at", context);
  reader.finish();
  if (!at) return std::nullopt;
  return Placed{PointLight{Imath::V3f(0)}, *at, {kPointScales, 4 * std::numbers::pi, inverse_square}};
}

std::optional<Placed> read_spot(const JsonValue& json, const LoadContext& context) {
  ObjectReader reader(json, context.diagnostics);
  const auto at = read_point(reader, "at", context);
  const auto axis = read_direction(reader, "direction", context);
  const auto half_angle = reader.require_number("half_angle_deg", kHalfAngle);
  reader.finish();
  if (!at || !axis || !half_angle) return std::nullopt;
  const double sine = std::sin(*half_angle * std::numbers::pi / 360);
  const SpotLight spot{Imath::V3f(0), Imath::V3f(*axis), static_cast<float>(2 * sine * sine)};
  const double solid_angle = 2 * std::numbers::pi * static_cast<double>(spot.cap);
  return Placed{spot, *at, {kPointScales, solid_angle, inverse_square}};
}

std::optional<Placed> read_directional(ObjectReader& reader, const LoadContext& context) {
  const auto towards = read_direction(reader, "towards", context);
  if (!towards) return std::nullopt;
  return Placed{
      DirectionalLight{Imath::V3f(*towards)}, {0, 0, 0}, {kBeamScales, 0, [](double) { return 1.0; }, true}};
}

std::optional<Placed> read_sun(ObjectReader& reader, const LoadContext& context) {
  const auto towards = read_direction(reader, "towards", context);
  const JsonValue* json = reader.find("angular_diameter_deg");
  const auto diameter = reader.number("angular_diameter_deg", kDiameter);
  if (!towards || (json && !diameter)) return std::nullopt;
  const double sine = std::sin(diameter.value_or(kSunDiameter_deg) * std::numbers::pi / 720);
  const SunLight sun{Imath::V3f(*towards), static_cast<float>(2 * sine * sine)};
  const double of_unit = sun.projected_solid_angle();
  return Placed{sun, {0, 0, 0}, {kSunScales, 0, [of_unit](double) { return of_unit; }, true}};
}

// The emission of daylight that a light from infinity has of an `irradiance` or `illuminance` of its own.
std::optional<JsonValue> daylight(ObjectReader& reader) {
  for (const std::string_view name : kBeamScales)
    if (const JsonValue* scale = reader.find(name))
      return JsonValue{
          JsonValue::Object{{"illuminant", {std::string{"D65"}, scale->where}}, {std::string(name), *scale}},
          scale->where};
  return std::nullopt;
}

// A light may say its strength itself, without an emission beside it.
void add_from_infinity(ObjectReader& reader, std::string name, std::string_view key, LoadContext& context,
                       Scene& scene) {
  const JsonValue* emission = reader.find("emission");
  ObjectReader of_light(*reader.find(key), context.diagnostics);
  const auto light = key == "sun" ? read_sun(of_light, context) : read_directional(of_light, context);
  const auto own = emission ? std::nullopt : daylight(of_light);
  of_light.finish();
  if (!own) emission = reader.require("emission");
  reader.finish();
  if (!light || (!own && !emission)) return;
  auto curve = read_emission(own ? *own : *emission, light->lamp, context);
  if (!curve) return;
  scene.lights.push_back({std::move(name), light->kind, std::move(*curve)});
  context.light_positions.push_back(light->position);
}

void add_environment(ObjectReader& reader, std::string name, const JsonValue& json, LoadContext& context,
                     Scene& scene) {
  auto sky = read_sky(json, context);
  const JsonValue* emission = reader.require("emission");
  reader.finish();
  for (const Light& light : scene.lights) {
    if (!light.is_environment()) continue;
    context.diagnostics.error(
        json.where, fmt::format("a scene has one environment (got another beside \"{}\")", light.name));
    return;
  }
  if (!sky || !emission) return;
  auto curve = read_emission(*emission, {kEnvironmentScales, 0}, context);
  if (!curve) return;
  EnvironmentLight light;
  if (!sky->texels.empty())
    light.image = std::make_shared<const EnvironmentImage>(sky->width, sky->height, std::move(sky->texels),
                                                           sky->frame, curve->curve(), scene.channels);
  scene.lights.push_back({std::move(name), std::move(light), std::move(*curve)});
  context.light_positions.push_back({0, 0, 0});
}

void add_placed(ObjectReader& reader, std::string name, const std::optional<Placed>& placed,
                LoadContext& context, Scene& scene) {
  const JsonValue* emission = reader.require("emission");
  reader.finish();
  if (!placed || !emission) return;
  auto curve = read_emission(*emission, placed->lamp, context);
  if (!curve) return;
  scene.lights.push_back({std::move(name), placed->kind, std::move(*curve)});
  context.light_positions.push_back(placed->position);
}

void add_area(ObjectReader& reader, std::string name, std::optional<PlainShape> shape, LoadContext& context,
              Scene& scene) {
  const JsonValue* emission = reader.require("emission");
  const JsonValue* material_name = reader.find("material");
  const bool two_sided = reader.boolean_or("two_sided", false);
  reader.finish();
  const auto material =
      material_name ? find_material(*material_name, context, scene) : black_material(context, scene);
  if (!shape || !emission || !material) return;
  scene.shapes.push_back({std::move(name), as_shape(*std::move(shape)), *material});
  add_area_light(*emission, two_sided, static_cast<std::uint32_t>(scene.shapes.size() - 1), context, scene);
}

void read_light(const JsonValue& json, std::size_t number, LoadContext& context, Scene& scene) {
  ObjectReader reader(json, context.diagnostics);
  std::string name = reader.string("name").value_or(fmt::format("light {}", number));
  const auto key =
      reader.exactly_one({"quad", "sphere", "disc", "point", "spot", "directional", "sun", "environment"});
  if (!key) return;
  const JsonValue& kind = *reader.find(*key);
  if (*key == "quad" || *key == "sphere" || *key == "disc") {
    add_area(reader, std::move(name), read_geometry(kind, *key, context), context, scene);
  } else if (*key == "point") {
    add_placed(reader, std::move(name), read_point_light(kind, context), context, scene);
  } else if (*key == "spot") {
    add_placed(reader, std::move(name), read_spot(kind, context), context, scene);
  } else if (*key == "directional" || *key == "sun") {
    add_from_infinity(reader, std::move(name), *key, context, scene);
  } else {
    add_environment(reader, std::move(name), kind, context, scene);
  }
}

// Of a surface on the axis that faces the lamp, for unit radiance [sr]; 0 within it.
double axial_irradiance(const Sphere& sphere, double distance) {
  const double sine = sphere.radius / distance;
  return sine < 1 ? std::numbers::pi * sine * sine : 0;
}
double axial_irradiance(const Disc& disc, double distance) {
  const double r2 = disc.radius * disc.radius;
  return std::numbers::pi * r2 / (r2 + distance * distance);
}
// Half the sum over the edges of the angle each takes up, times how it leans [Lambert1760]: with a and b from
// the middle to the corners and n the normal, the plane through an edge and the point has the normal (a + n
// d) x (b + n d), whose part along n is that of a x b. Taken so, nothing cancels however far the point is.
double axial_irradiance(const Quad& quad, double distance) {
  const Imath::V3d normal = normal_of(quad);
  const Imath::V3d first = (quad.edge_u + quad.edge_v) / -2;
  const std::array corners{first, first + quad.edge_u, -first, first + quad.edge_v};
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Imath::V3d& a = corners.at(i);
    const Imath::V3d& b = corners.at((i + 1) % corners.size());
    const double along = a.cross(b).dot(normal);
    const double across = std::hypot(along, distance * (b - a).length());
    sum += std::atan2(across, a.dot(b) + distance * distance) * along / across;
  }
  return std::abs(sum) / 2;
}

LampKind area_lamp(const Shape& shape, bool two_sided) {
  LampKind kind{kAreaScales, std::numbers::pi * area(shape) * (two_sided ? 2 : 1)};
  const auto lamp = [&kind](const auto& plain_shape) {
    kind.scales = kLampScales;
    kind.irradiance = [plain_shape](double distance) { return axial_irradiance(plain_shape, distance); };
  };
  if (const auto* sphere = plain<Sphere>(shape)) lamp(*sphere);
  if (const auto* disc = plain<Disc>(shape)) lamp(*disc);
  if (const auto* quad = plain<Quad>(shape)) lamp(*quad);
  return kind;
}

}  // namespace

void add_area_light(const JsonValue& emission, bool two_sided, std::uint32_t shape, LoadContext& context,
                    Scene& scene) {
  const ShapeInstance& instance = scene.shapes[shape];
  if (is_boundary(scene.materials[instance.material])) {
    context.diagnostics.error(emission.where, "a medium has no surface that could emit");
    return;
  }
  auto curve = read_emission(emission, area_lamp(instance.shape, two_sided), context);
  if (!curve) return;
  scene.lights.push_back({instance.name, AreaLight{shape, two_sided}, std::move(*curve)});
  context.light_positions.push_back({0, 0, 0});
}

void read_lights(const JsonValue& json, LoadContext& context, Scene& scene) {
  const JsonValue::Array* list = read_array(json, "lights", 0, context.diagnostics);
  if (!list) return;
  for (std::size_t i = 0; i < list->size(); ++i) {
    read_light((*list)[i], i, context, scene);
    context.shape_places.resize(scene.shapes.size(), (*list)[i].where);
  }
}

}  // namespace abbe::description
