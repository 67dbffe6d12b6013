#include <utility>

#include <fmt/format.h>

#include "description/material.h"
#include "io/npy.h"

namespace abbe::description {
namespace {

PhaseFunction build_phase(const spec::Scattering& spec) {
  if (!spec.phase) return IsotropicPhase{};
  if (const auto* peak = std::get_if<spec::HenyeyGreenstein>(&spec.phase->value))
    return HenyeyGreensteinPhase{static_cast<float>(peak->g)};
  if (std::get<spec::PhaseWord>(spec.phase->value) == spec::PhaseWord::isotropic) return IsotropicPhase{};
  return RayleighPhase{};
}

// Builds a coefficient [1/m]; 0 if the key is absent.
std::optional<Curve> build_coefficient(const std::optional<spec::Curve>& spec, LoadContext& context) {
  if (!spec) return Curve(0.0);
  return build(*spec, {"filter", spec::kPower, CurveUnit::per_metre}, context);
}

std::optional<DensityGrid> build_densities(const schema::Located<std::string>& spec, LoadContext& context) {
  const SourcePosition& where = spec.where;
  const auto path = context.file(spec.value, where);
  if (!path) return std::nullopt;
  NumberArray array;
  try {
    array = read_npy(*path, context.inputs);
  } catch (const Error& e) {
    context.diagnostics.error(where, e.what(), e.code);
    return std::nullopt;
  }
  const auto fault = [&](std::string_view what) {
    context.diagnostics.error(where, fmt::format("\"{}\" {}", spec.value, what), ErrorCode::input);
    return std::nullopt;
  };
  if (array.shape.size() != 3)
    return fault(fmt::format("has {} axes, allowed 3: z, y, x", array.shape.size()));
  for (const std::size_t nodes : array.shape)
    if (nodes < 2) return fault("has an axis of fewer than 2 nodes");
  for (const float density : array.values)
    if (!(density >= 0 && density <= 1e9F)) return fault("has a density that is not in [0, 1e9]");
  const auto& n = array.shape;
  return DensityGrid{{static_cast<int>(n[2]), static_cast<int>(n[1]), static_cast<int>(n[0])},
                     std::move(array.values)};
}

}  // namespace

std::optional<PlacedGrid> build(const spec::Grid& spec, LoadContext& context) {
  const Imath::V3d from = spec.from * context.unit_m;
  const Imath::V3d to = spec.to * context.unit_m;
  if (!(to.x > from.x && to.y > from.y && to.z > from.z)) {
    context.diagnostics.error(spec.where, "the grid's `to` must be greater than its `from` along x, y and z");
    return std::nullopt;
  }
  auto grid = build_densities(spec.densities, context);
  if (!grid) return std::nullopt;
  return PlacedGrid{std::make_shared<const DensityGrid>(std::move(*grid)), from, to};
}

std::optional<Medium> build(const spec::Scattering& spec, const std::optional<spec::Curve>& absorption,
                            LoadContext& context) {
  auto scatters = build_coefficient(spec.per_m, context);
  auto absorbs = build_coefficient(absorption, context);
  if (spec.phase && !spec.per_m)
    context.diagnostics.warning(spec.phase->where, "phase has no effect without scattering_per_m");
  if (!scatters || !absorbs) return std::nullopt;
  return Medium{std::move(*absorbs), std::move(*scatters), build_phase(spec)};
}

}  // namespace abbe::description
