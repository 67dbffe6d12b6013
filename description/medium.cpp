#include <utility>

#include <fmt/format.h>

#include "description/curve.h"
#include "description/material_readers.h"
#include "description/values.h"
#include "io/npy.h"
#include "io/schema/read.h"

namespace abbe::spec {

/// Densities at the nodes of a grid.
struct Grid {
  schema::Located<std::string> densities;
  Imath::V3d from{0, 0, 0};
  Imath::V3d to{0, 0, 0};
  SourcePosition where;
};
static const schema::Fields& fields(schema::Tag<Grid>) {
  using namespace schema;
  static const Fields kFields = describe<Grid>(
      "grid", "Densities that multiply absorption and scattering.",
      {field("densities", &Grid::densities, text(), "A NumPy file of axes z, y, x."),
       field("from", &Grid::from, point(), "Position of the first node."),
       field("to", &Grid::to, point(), "Position of the last node, beyond the first along x, y and z.")});
  return kFields;
}

}  // namespace abbe::spec

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

std::optional<DensityGrid> build_densities(const schema::Located<std::string>& said, LoadContext& context) {
  const SourcePosition& where = said.where;
  const auto path = context.file(said.value, where);
  if (!path) return std::nullopt;
  NumberArray array;
  try {
    array = read_npy(*path, context.inputs);
  } catch (const Error& e) {
    context.diagnostics.error(where, e.what(), e.code);
    return std::nullopt;
  }
  const auto fault = [&](std::string_view what) {
    context.diagnostics.error(where, fmt::format("\"{}\" {}", said.value, what), ErrorCode::input);
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

std::optional<PlacedGrid> build(const spec::Grid& said, LoadContext& context) {
  const Imath::V3d from = said.from * context.unit_m;
  const Imath::V3d to = said.to * context.unit_m;
  if (!(to.x > from.x && to.y > from.y && to.z > from.z)) {
    context.diagnostics.error(said.where, "the grid's `to` must lie beyond its `from` along x, y and z");
    return std::nullopt;
  }
  auto grid = build_densities(said.densities, context);
  if (!grid) return std::nullopt;
  return PlacedGrid{std::make_shared<const DensityGrid>(std::move(*grid)), from, to};
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
    const auto said = schema::read<spec::Grid>(*grid, context.diagnostics);
    if (said) filling->grid = build(*said, context);
    if (!filling->grid) return std::nullopt;
  }
  return MediumMaterial{std::move(*filling)};
}

}  // namespace abbe::description
