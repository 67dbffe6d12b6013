#include <utility>

#include <fmt/format.h>

#include "description/curve.h"
#include "description/material_readers.h"
#include "description/values.h"
#include "io/npy.h"

namespace abbe::description {
namespace {

// Beyond it a cosine's float says nothing about the peak.
constexpr double kMostPeaked = 0.9999;

std::optional<PhaseFunction> read_phase(const JsonValue& json, LoadContext& context) {
  if (std::holds_alternative<std::string>(json.value)) {
    const auto choice = read_choice(json, "phase function", {"isotropic", "rayleigh"}, context.diagnostics);
    if (!choice) return std::nullopt;
    return *choice == 0 ? PhaseFunction{IsotropicPhase{}} : RayleighPhase{};
  }
  ObjectReader reader(json, context.diagnostics);
  const auto g = reader.require_number("henyey_greenstein", {-kMostPeaked, kMostPeaked});
  reader.finish();
  if (!g) return std::nullopt;
  return HenyeyGreensteinPhase{static_cast<float>(*g)};
}

// Per metre; that of nothing where the key is absent.
std::optional<Curve> read_coefficient(const JsonValue* json, LoadContext& context) {
  if (json == nullptr) return Curve(0.0);
  return read_curve(*json, {"filter", kPower}, context);
}

std::optional<DensityGrid> read_densities(const JsonValue& json, LoadContext& context) {
  const auto name = read_string(json, context.diagnostics);
  const auto path = name ? context.file(*name, json.where) : std::nullopt;
  if (!path) return std::nullopt;
  NumberArray array;
  try {
    array = read_npy(*path, context.inputs);
  } catch (const Error& e) {
    context.diagnostics.error(json.where, e.what(), e.code);
    return std::nullopt;
  }
  const auto fault = [&](std::string_view what) {
    context.diagnostics.error(json.where, fmt::format("\"{}\" {}", *name, what), ErrorCode::input);
    return std::nullopt;
  };
  if (array.shape.size() != 3)
    return fault(fmt::format("has {} axes, allowed 3: z, y, x", array.shape.size()));
  for (const std::size_t nodes : array.shape)
    if (nodes < 2) return fault("has an axis of less than 2 nodes");
  for (const float density : array.values)
    if (!(density >= 0 && density <= 1e9F)) return fault("has a density that is not in [0, 1e9]");
  const auto& n = array.shape;
  return DensityGrid{{static_cast<int>(n[2]), static_cast<int>(n[1]), static_cast<int>(n[0])},
                     std::move(array.values)};
}

std::optional<PlacedGrid> read_grid(const JsonValue& json, LoadContext& context) {
  ObjectReader reader(json, context.diagnostics);
  const JsonValue* densities = reader.require("densities");
  const auto from = read_point(reader, "from", context);
  const auto to = read_point(reader, "to", context);
  reader.finish();
  if (!densities || !from || !to) return std::nullopt;
  if (!(to->x > from->x && to->y > from->y && to->z > from->z)) {
    context.diagnostics.error(json.where, "the grid's `to` must lie beyond its `from` along x, y and z");
    return std::nullopt;
  }
  auto grid = read_densities(*densities, context);
  if (!grid) return std::nullopt;
  return PlacedGrid{std::make_shared<const DensityGrid>(std::move(*grid)), *from, *to};
}

}  // namespace

std::optional<Medium> read_filling(ObjectReader& reader, bool absorbs, LoadContext& context) {
  const JsonValue* phase = reader.find("phase");
  auto scattering = read_coefficient(reader.find("scattering_per_m"), context);
  auto absorption = read_coefficient(absorbs ? reader.find("absorption_per_m") : nullptr, context);
  const auto turns = phase ? read_phase(*phase, context) : PhaseFunction{IsotropicPhase{}};
  if (!scattering || !absorption || !turns) return std::nullopt;
  return Medium{std::move(*absorption), std::move(*scattering), *turns};
}

std::optional<MaterialModel> read_medium(const JsonValue& json, LoadContext& context) {
  ObjectReader reader(json, context.diagnostics);
  auto filling = read_filling(reader, true, context);
  const JsonValue* grid = reader.find("grid");
  reader.finish();
  if (!filling) return std::nullopt;
  if (grid) {
    filling->grid = read_grid(*grid, context);
    if (!filling->grid) return std::nullopt;
  }
  return MediumMaterial{std::move(*filling)};
}

}  // namespace abbe::description
