#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "scene/description/pieces.h"
#include "spectral/colorimetry.h"
#include "spectral/library.h"

namespace abbe::description {
namespace {

using Keys = std::span<const std::string_view>;
constexpr std::array<std::string_view, 4> kAreaScales{"radiant_flux_W", "luminous_flux_lm", "radiance",
                                                      "luminance"};
constexpr std::array<std::string_view, 4> kPointScales{"radiant_flux_W", "luminous_flux_lm", "intensity",
                                                       "luminous_intensity"};
constexpr std::array<std::string_view, 2> kEnvironmentScales{"radiance", "luminance"};

constexpr Range kHalfAngle{0.1, 180};  // degrees: below, a float's cosine no longer tells cones apart

/// What fixes the strength of a lamp of one kind: the scales it may name, and the flux of a lamp of unit
/// radiance or intensity.
struct LampKind {
  Keys scales;
  double flux;  ///< [m^2 sr] for radiance, [sr] for intensity.
};

std::optional<Curve> read_spectrum(std::string_view key, const JsonValue& json, Reading& reading) {
  if (key == "spectrum") return read_curve(json, {"illuminant", kPower}, reading);
  if (key != "illuminant") return read_source(key, json, reading);
  const std::optional<std::string> name = reading.table(json);
  if (!name) return std::nullopt;
  std::optional<NamedCurve> named = load_illuminant(*name, json.where, reading.diagnostics);
  if (!named) return std::nullopt;
  return std::move(named->curve);
}

// `spectrum` scaled so that the quantity `scale` names has the value asked for.
std::optional<Curve> normalised(const Curve& spectrum, std::string_view scale, double value,
                                const LampKind& kind, const SourcePosition& where, const Reading& reading) {
  const bool luminous = scale.starts_with("lumin");
  const bool flux = scale == "radiant_flux_W" || scale == "luminous_flux_lm";
  const double unscaled = (luminous ? photometric(spectrum) : spectrum.integral()) * (flux ? kind.flux : 1);
  if (unscaled > 0) return scaled(spectrum, value / unscaled);
  reading.diagnostics.error(where, fmt::format("{} cannot scale this spectrum, which has none", scale));
  return std::nullopt;
}

std::optional<Curve> read_emission(const JsonValue& json, const LampKind& kind, Reading& reading) {
  ObjectReader reader(json, reading.diagnostics);
  const auto key = reader.exactly_one({"illuminant", "blackbody_K", "daylight_K", "spectrum", "lines"});
  if (!key) return std::nullopt;
  std::optional<Curve> spectrum = read_spectrum(*key, *reader.find(*key), reading);
  std::string_view scale;
  std::optional<double> value;
  for (std::string_view candidate : kind.scales) {
    if (!reader.find(candidate)) continue;
    if (!scale.empty())
      reading.diagnostics.error(json.where,
                                fmt::format("an emission has one scale (got {} and {})", scale, candidate));
    scale = candidate;
    value = reader.number(candidate, kPower);
  }
  reader.finish();
  const bool relative = *key == "illuminant" || *key == "daylight_K";
  if (scale.empty() && relative)
    reading.diagnostics.error(json.where,
                              fmt::format("{} is a relative spectrum and needs a scale, one of {}", *key,
                                          fmt::join(kind.scales, ", ")));
  if (!spectrum || (scale.empty() && relative) || (!scale.empty() && !value)) return std::nullopt;
  if (scale.empty()) return spectrum;
  return normalised(*spectrum, scale, *value, kind, json.where, reading);
}

/// A light at a point: where it is, and how it spreads.
struct Placed {
  decltype(Light::kind) kind;
  Imath::V3d position{0, 0, 0};
  LampKind lamp;
};

std::optional<Placed> read_point_light(const JsonValue& json, const Reading& reading) {
  ObjectReader reader(json, reading.diagnostics);
  const auto at = read_point(reader, "at", reading);
  reader.finish();
  if (!at) return std::nullopt;
  return Placed{PointLight{Imath::V3f(0)}, *at, {kPointScales, 4 * std::numbers::pi}};
}

std::optional<Placed> read_spot(const JsonValue& json, const Reading& reading) {
  ObjectReader reader(json, reading.diagnostics);
  const auto at = read_point(reader, "at", reading);
  const auto axis = read_direction(reader, "direction", reading);
  const auto half_angle = reader.require_number("half_angle_deg", kHalfAngle);
  reader.finish();
  if (!at || !axis || !half_angle) return std::nullopt;
  const double sine = std::sin(*half_angle * std::numbers::pi / 360);
  const SpotLight spot{Imath::V3f(0), Imath::V3f(*axis), static_cast<float>(2 * sine * sine)};
  const double solid_angle = 2 * std::numbers::pi * static_cast<double>(spot.cap);
  return Placed{spot, *at, {kPointScales, solid_angle}};
}

void add_environment(ObjectReader& reader, std::string name, const JsonValue& json, Reading& reading,
                     Scene& scene) {
  auto sky = read_sky(json, reading);
  const JsonValue* emission = reader.require("emission");
  reader.finish();
  for (const Light& light : scene.lights) {
    if (!light.is_environment()) continue;
    reading.diagnostics.error(
        json.where, fmt::format("a scene has one environment (got another beside \"{}\")", light.name));
    return;
  }
  if (!sky || !emission) return;
  auto curve = read_emission(*emission, {kEnvironmentScales, 1}, reading);
  if (!curve) return;
  EnvironmentLight light;
  if (!sky->texels.empty())
    light.image = std::make_shared<const EnvironmentImage>(sky->width, sky->height, std::move(sky->texels),
                                                           sky->frame, *curve, scene.channels);
  scene.lights.push_back({std::move(name), std::move(light), std::move(*curve)});
  reading.light_positions.push_back({0, 0, 0});
}

void add_placed(ObjectReader& reader, std::string name, const std::optional<Placed>& placed, Reading& reading,
                Scene& scene) {
  const JsonValue* emission = reader.require("emission");
  reader.finish();
  if (!placed || !emission) return;
  auto curve = read_emission(*emission, placed->lamp, reading);
  if (!curve) return;
  scene.lights.push_back({std::move(name), placed->kind, std::move(*curve)});
  reading.light_positions.push_back(placed->position);
}

template <typename S>
std::optional<Shape> as_shape(std::optional<S> shape) {
  if (!shape) return std::nullopt;
  return Shape(std::move(*shape));
}

void add_area(ObjectReader& reader, std::string name, std::optional<Shape> shape, Reading& reading,
              Scene& scene) {
  const JsonValue* emission = reader.require("emission");
  const JsonValue* material_name = reader.find("material");
  const bool two_sided = reader.boolean_or("two_sided", false);
  reader.finish();
  const auto material =
      material_name ? find_material(*material_name, reading, scene) : black_material(reading, scene);
  if (!shape || !emission || !material) return;
  scene.shapes.push_back({std::move(name), std::move(*shape), *material});
  add_area_light(*emission, two_sided, static_cast<std::uint32_t>(scene.shapes.size() - 1), reading, scene);
}

void read_light(const JsonValue& json, std::size_t number, Reading& reading, Scene& scene) {
  ObjectReader reader(json, reading.diagnostics);
  std::string name = reader.string("name").value_or(fmt::format("light {}", number));
  const auto key = reader.exactly_one({"quad", "sphere", "disc", "point", "spot", "environment"});
  if (!key) return;
  const JsonValue& kind = *reader.find(*key);
  if (*key == "quad") {
    add_area(reader, std::move(name), as_shape(read_quad(kind, reading)), reading, scene);
  } else if (*key == "sphere") {
    add_area(reader, std::move(name), as_shape(read_sphere(kind, reading)), reading, scene);
  } else if (*key == "disc") {
    add_area(reader, std::move(name), as_shape(read_disc(kind, reading)), reading, scene);
  } else if (*key == "point") {
    add_placed(reader, std::move(name), read_point_light(kind, reading), reading, scene);
  } else if (*key == "spot") {
    add_placed(reader, std::move(name), read_spot(kind, reading), reading, scene);
  } else {
    add_environment(reader, std::move(name), kind, reading, scene);
  }
}

}  // namespace

void add_area_light(const JsonValue& emission, bool two_sided, std::uint32_t shape, Reading& reading,
                    Scene& scene) {
  const ShapeInstance& instance = scene.shapes[shape];
  const double one_side = area(instance.shape);
  const double flux = std::numbers::pi * one_side * (two_sided ? 2 : 1);
  auto curve = read_emission(emission, {kAreaScales, flux}, reading);
  if (!curve) return;
  scene.lights.push_back({instance.name, AreaLight{shape, two_sided}, std::move(*curve)});
  reading.light_positions.push_back({0, 0, 0});
}

void read_lights(const JsonValue& json, Reading& reading, Scene& scene) {
  const JsonValue::Array* list = read_array(json, "lights", 0, reading);
  if (!list) return;
  for (std::size_t i = 0; i < list->size(); ++i) read_light((*list)[i], i, reading, scene);
}

}  // namespace abbe::description
