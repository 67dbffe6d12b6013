#include <utility>

#include <fmt/format.h>

#include "description/material_readers.h"
#include "description/values.h"

namespace abbe::description {
namespace {

constexpr double kClear = 1e-3;  // more k than any glass or varnish has, less than any metal

// Why `index` cannot be a coat's, if it cannot.
std::optional<std::string> coat_fault(const RefractiveIndex& index) {
  for (int nm = kMinWavelengthNm; nm <= kMaxWavelengthNm; ++nm) {
    if (index.n(nm) < 1)
      return fmt::format("a coat is denser than air (got n = {:g} at {} nm)", index.n(nm), nm);
    if (index.k(nm) > kClear)
      return fmt::format("a coat is clear (got k = {:g} at {} nm, allowed [0, {:g}])", index.k(nm), nm,
                         kClear);
  }
  return std::nullopt;
}

}  // namespace

std::optional<MaterialModel> read_coated_diffuse(const JsonValue& json, LoadContext& context) {
  ObjectReader reader(json, context.diagnostics);
  const JsonValue* ior_value = reader.require("ior");
  const JsonValue* reflectance_value = reader.require("reflectance");
  reader.finish();
  if (!ior_value || !reflectance_value) return std::nullopt;
  auto ior = read_ior(*ior_value, kIndex, context);
  auto reflectance = read_reflectance(*reflectance_value, context);
  if (!ior || !reflectance) return std::nullopt;
  if (const auto fault = coat_fault(ior->index)) {
    context.diagnostics.error(ior_value->where, *fault);
    return std::nullopt;
  }
  return CoatedDiffuseMaterial{std::move(ior->name), std::move(ior->index), std::move(*reflectance)};
}

std::optional<MaterialModel> read_thin_glass(const JsonValue& json, LoadContext& context) {
  ObjectReader reader(json, context.diagnostics);
  auto ior = read_tinted_ior(reader, context);
  const double thickness = reader.number_or("thickness", 0, {0, kMaxLength});
  reader.finish();
  if (!ior) return std::nullopt;
  return ThinGlassMaterial{std::move(ior->name), std::move(ior->index), thickness * context.unit_m};
}

}  // namespace abbe::description
