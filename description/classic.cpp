#include <cmath>
#include <utility>
#include <vector>

#include "description/material_readers.h"
#include "materials/interface/fresnel.h"

namespace abbe::description {
namespace {

constexpr Range kSigma{0, 90};  // [deg]
constexpr Range kExponent{0, 1e4};

std::optional<SpectralTexture> required_reflectance(ObjectReader& reader, LoadContext& context) {
  const JsonValue* value = reader.require("reflectance");
  return value ? read_reflectance(*value, context) : std::nullopt;
}

/// What all powers of a cosine have.
struct Power {
  SpectralTexture reflectance;
  double exponent;
};
std::optional<Power> read_power(ObjectReader& reader, LoadContext& context) {
  auto reflectance = required_reflectance(reader, context);
  const auto exponent = reader.require_number("exponent", kExponent);
  if (!reflectance || !exponent) return std::nullopt;
  return Power{std::move(*reflectance), *exponent};
}

// What matter of this index reflects along the normal.
Curve normal_reflectance(const RefractiveIndex& index) {
  std::vector<Knot> knots;
  for (int nm = kMinWavelengthNm; nm <= kMaxWavelengthNm; ++nm)
    knots.push_back({static_cast<double>(nm), fresnel_conductor(1.0, index.n(nm), index.k(nm)).R()});
  return Curve(std::move(knots));
}

}  // namespace

std::optional<MaterialModel> read_mirror(const JsonValue& json, LoadContext& context) {
  ObjectReader reader(json, context.diagnostics);
  auto reflectance = required_reflectance(reader, context);
  reader.finish();
  if (!reflectance) return std::nullopt;
  return MirrorMaterial{std::move(*reflectance)};
}

std::optional<MaterialModel> read_oren_nayar(const JsonValue& json, LoadContext& context) {
  ObjectReader reader(json, context.diagnostics);
  auto reflectance = required_reflectance(reader, context);
  const auto sigma = reader.require_number("sigma_deg", kSigma);
  reader.finish();
  if (!reflectance || !sigma) return std::nullopt;
  return OrenNayarMaterial{std::move(*reflectance), *sigma};
}

std::optional<MaterialModel> read_schlick(const JsonValue& json, LoadContext& context) {
  ObjectReader reader(json, context.diagnostics);
  const auto key = reader.exactly_one({"ior", "reflectance"});
  if (!key) return std::nullopt;
  std::optional<SpectralTexture> r0;
  if (*key == "reflectance") {
    r0 = required_reflectance(reader, context);
  } else if (const auto ior = read_ior(*reader.find("ior"), kMetalIndex, context)) {
    r0 = normal_reflectance(ior->index);
  }
  reader.finish();
  if (!r0) return std::nullopt;
  return SchlickMaterial{std::move(*r0)};
}

std::optional<MaterialModel> read_cosine_power(const JsonValue& json, LoadContext& context) {
  ObjectReader reader(json, context.diagnostics);
  auto power = read_power(reader, context);
  const bool reciprocal = reader.boolean_or("reciprocal", false);
  reader.finish();
  if (!power) return std::nullopt;
  return CosinePowerMaterial{std::move(power->reflectance), power->exponent, reciprocal};
}

std::optional<MaterialModel> read_phong(const JsonValue& json, LoadContext& context) {
  ObjectReader reader(json, context.diagnostics);
  auto power = read_power(reader, context);
  reader.finish();
  if (!power) return std::nullopt;
  return PhongMaterial{std::move(power->reflectance), power->exponent};
}

std::optional<MaterialModel> read_retroreflector(const JsonValue& json, LoadContext& context) {
  ObjectReader reader(json, context.diagnostics);
  auto power = read_power(reader, context);
  reader.finish();
  if (!power) return std::nullopt;
  return RetroreflectorMaterial{std::move(power->reflectance), power->exponent};
}

}  // namespace abbe::description
