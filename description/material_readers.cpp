#include "description/material_readers.h"

#include "description/curve.h"
#include "description/values.h"

#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "materials/index/library.h"

namespace abbe::description {
namespace {

constexpr Range kExtinction{0, 100};

// k of an absorption coefficient alpha [1/m]: alpha lambda/(4 pi), lambda in metres.
Curve extinction(const Curve& absorption_per_m) {
  const auto k = [](double nm) { return nm * 1e-9 / (4 * std::numbers::pi); };
  const Curve per_alpha(
      std::vector<Knot>{{kMinWavelengthNm, k(kMinWavelengthNm)}, {kMaxWavelengthNm, k(kMaxWavelengthNm)}});
  return product(absorption_per_m, per_alpha);
}

std::optional<Ior> constant_ior(double n, double k) {
  return Ior{k > 0 ? fmt::format("{} + {}i", n, k) : fmt::format("{}", n), RefractiveIndex(n, k), true};
}

MaterialModel dielectric(Ior ior, Coating coating, const std::optional<Microfacets<float>>& facets,
                         std::optional<Medium> filling) {
  if (facets)
    return RoughDielectricMaterial(std::move(ior.name), std::move(ior.index), *facets, std::move(filling));
  return DielectricMaterial{std::move(ior.name), std::move(ior.index), std::move(coating),
                            std::move(filling)};
}

}  // namespace

std::optional<Ior> read_ior(const JsonValue& json, Range allowed, LoadContext& context) {
  if (std::holds_alternative<double>(json.value)) {
    const auto n = read_number(json, allowed, context.diagnostics);
    return n ? constant_ior(*n, 0) : std::nullopt;
  }
  if (std::holds_alternative<JsonValue::Object>(json.value)) {
    ObjectReader reader(json, context.diagnostics);
    const auto n = reader.require_number("n", allowed);
    const double k = reader.number_or("k", 0, kExtinction);
    reader.finish();
    return n ? constant_ior(*n, k) : std::nullopt;
  }
  const auto name = context.table(json);
  if (!name) return std::nullopt;
  auto named = load_index(*name, json.where, context.diagnostics);
  if (!named) return std::nullopt;
  return Ior{std::move(named->name), std::move(named->index), false};
}

std::optional<MaterialModel> read_diffuse(const JsonValue& json, LoadContext& context) {
  ObjectReader reader(json, context.diagnostics);
  const JsonValue* value = reader.require("reflectance");
  reader.finish();
  if (!value) return std::nullopt;
  auto reflectance = read_reflectance(*value, context);
  if (!reflectance) return std::nullopt;
  return DiffuseMaterial{std::move(*reflectance)};
}

std::optional<Ior> read_tinted_ior(ObjectReader& reader, LoadContext& context) {
  const JsonValue* value = reader.require("ior");
  const JsonValue* absorption = reader.find("absorption_per_m");
  if (!value) return std::nullopt;
  auto ior = read_ior(*value, kIndex, context);
  if (!ior || !absorption) return ior;
  if (!ior->constant || ior->index.absorbing()) {
    context.diagnostics.error(absorption->where,
                              "absorption_per_m goes with a constant real index; this one brings its own k");
    return std::nullopt;
  }
  const auto alpha = read_curve(*absorption, {"filter", kPower}, context);
  if (!alpha) return std::nullopt;
  ior->index = RefractiveIndex(Curve(ior->index.catalogued_n(kMinWavelengthNm)), extinction(*alpha),
                               IndexMedium::air, kMinWavelengthNm, kMaxWavelengthNm);
  return ior;
}

std::optional<MaterialModel> read_dielectric(const JsonValue& json, LoadContext& context) {
  ObjectReader reader(json, context.diagnostics);
  auto ior = read_tinted_ior(reader, context);
  auto filling = read_filling(reader, false, context);
  Coating coating = read_coating(reader.find("coating"), context);
  const auto facets = read_roughness(reader.find("roughness"), coating, context);
  reader.finish();
  if (!ior || !filling) return std::nullopt;
  if (!filling->scatters()) filling.reset();
  return dielectric(std::move(*ior), std::move(coating), facets, std::move(filling));
}

std::optional<MaterialModel> read_conductor(const JsonValue& json, LoadContext& context) {
  ObjectReader reader(json, context.diagnostics);
  const JsonValue* value = reader.require("ior");
  Coating coating = read_coating(reader.find("coating"), context);
  const auto facets = read_roughness(reader.find("roughness"), coating, context);
  reader.finish();
  if (!value) return std::nullopt;
  auto ior = read_ior(*value, kMetalIndex, context);
  if (!ior) return std::nullopt;
  if (facets) return RoughConductorMaterial(std::move(ior->name), std::move(ior->index), *facets);
  return ConductorMaterial{std::move(ior->name), std::move(ior->index), std::move(coating)};
}

std::optional<MaterialModel> read_film(const JsonValue& json, LoadContext& context) {
  ObjectReader reader(json, context.diagnostics);
  Coating coating = read_coating(reader.require("layers"), context);
  reader.finish();
  return DielectricMaterial{"air", RefractiveIndex(1), std::move(coating)};
}

}  // namespace abbe::description
