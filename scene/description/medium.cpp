#include <utility>

#include <fmt/format.h>

#include "io/npy.h"
#include "scene/description/matter.h"

namespace abbe::description {
namespace {

// Beyond it a cosine's float says nothing about the peak.
constexpr double kMostPeaked = 0.9999;

std::optional<PhaseFunction> read_phase(const JsonValue& json, Reading& reading) {
  if (std::holds_alternative<std::string>(json.value)) {
    const auto choice = read_choice(json, "phase function", {"isotropic", "rayleigh"}, reading.diagnostics);
    if (!choice) return std::nullopt;
    return *choice == 0 ? PhaseFunction{IsotropicPhase{}} : RayleighPhase{};
  }
  ObjectReader reader(json, reading.diagnostics);
  const auto g = reader.require_number("henyey_greenstein", {-kMostPeaked, kMostPeaked});
  reader.finish();
  if (!g) return std::nullopt;
  return HenyeyGreensteinPhase{static_cast<float>(*g)};
}

// Per metre; that of nothing where the key is absent.
std::optional<Curve> read_coefficient(const JsonValue* json, Reading& reading) {
  if (json == nullptr) return Curve(0.0);
  return read_curve(*json, {"filter", kPower}, reading);
}

std::optional<DensityGrid> read_densities(const JsonValue& json, Reading& reading) {
  const auto name = read_string(json, reading.diagnostics);
  const auto path = name ? reading.file(*name, json.where) : std::nullopt;
  if (!path) return std::nullopt;
  NumberArray array;
  try {
    array = read_npy(*path, reading.inputs);
  } catch (const Error& e) {
    reading.diagnostics.error(json.where, e.what(), e.code);
    return std::nullopt;
  }
  const auto fault = [&](std::string_view what) {
    reading.diagnostics.error(json.where, fmt::format("\"{}\" {}", *name, what), ErrorCode::input);
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

std::optional<PlacedGrid> read_grid(const JsonValue& json, Reading& reading) {
  ObjectReader reader(json, reading.diagnostics);
  const JsonValue* densities = reader.require("densities");
  const auto from = read_point(reader, "from", reading);
  const auto to = read_point(reader, "to", reading);
  reader.finish();
  if (!densities || !from || !to) return std::nullopt;
  if (!(to->x > from->x && to->y > from->y && to->z > from->z)) {
    reading.diagnostics.error(json.where, "the grid's `to` must lie beyond its `from` along x, y and z");
    return std::nullopt;
  }
  auto grid = read_densities(*densities, reading);
  if (!grid) return std::nullopt;
  return PlacedGrid{std::make_shared<const DensityGrid>(std::move(*grid)), *from, *to};
}

}  // namespace

std::optional<Matter> read_filling(ObjectReader& reader, bool absorbs, Reading& reading) {
  const JsonValue* phase = reader.find("phase");
  auto scattering = read_coefficient(reader.find("scattering_per_m"), reading);
  auto absorption = read_coefficient(absorbs ? reader.find("absorption_per_m") : nullptr, reading);
  const auto turns = phase ? read_phase(*phase, reading) : PhaseFunction{IsotropicPhase{}};
  if (!scattering || !absorption || !turns) return std::nullopt;
  return Matter{std::move(*absorption), std::move(*scattering), *turns};
}

std::optional<MaterialModel> read_medium(const JsonValue& json, Reading& reading) {
  ObjectReader reader(json, reading.diagnostics);
  auto filling = read_filling(reader, true, reading);
  const JsonValue* grid = reader.find("grid");
  reader.finish();
  if (!filling) return std::nullopt;
  if (grid) {
    filling->grid = read_grid(*grid, reading);
    if (!filling->grid) return std::nullopt;
  }
  return MediumMaterial{std::move(*filling)};
}

}  // namespace abbe::description
