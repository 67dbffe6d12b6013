#include "description/probe.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "description/value_ranges.h"

namespace abbe::spec {

using namespace schema;

static Fields fields(Tag<PointProbe>) {
  return describe("point_probe", "",
                  {field("at", &PointProbe::at, kCoordinate, "Position of a point probe."),
                   field("normal", &PointProbe::normal, direction(), "Direction that the point faces.")});
}

static Fields fields(Tag<SphereProbe>) {
  return describe(
      "sphere_probe", "A spherical probe.",
      {inlined(&SphereProbe::sphere),
       defaulted("facing", &SphereProbe::facing, enumeration<Facing>("side", {"outwards", "inwards"}),
                 "Receives light from outside, or from inside the sphere.")});
}

Fields fields(Tag<Probe>) {
  return describe(
      "probe", "A surface that records the light that reaches it. It is invisible to light.",
      {one_of(&Probe::surface, inlined_by<PointProbe>("at"),
              under<Quad>("quad", "A parallelogram, one patch per pixel; it faces edge_u x edge_v."),
              under<Disc>("disc", "A disc that faces its normal."), under<SphereProbe>("sphere")),
       field(
           "acceptance_deg", &Probe::acceptance_deg, Range{0.01, 90}.in("degrees"),
           "Largest angle from the normal at which light is accepted; if absent 90, the whole hemisphere.")});
}

Fields fields(Tag<Meter>) {
  return describe(
      "meter", "A light meter, for `abbe meter`.",
      {defaulted("measures", &Meter::measures,
                 enumeration<MeterQuantity>("quantity", {"irradiance", "flux", "radiance", "intensity"}),
                 "Quantity to report, weighted by the channels: the irradiance of the surface; the flux "
                 "through it; the mean radiance in the cone of `acceptance_deg`; or the flux per solid angle "
                 "of that cone."),
       inlined(&Meter::probe),
       field("cells", &Meter::cells, vector<std::array<std::int64_t, 2>>(Range{1, 256}),
             "Number of cells of a quad along edge_u and edge_v, which are also reported."),
       field("spectrum", &Meter::spectrum, "Wavelength bins in which the quantity is also reported.")});
}

}  // namespace abbe::spec

namespace abbe::description {
namespace {

// Reports combinations that the key table cannot exclude.
void check(const spec::Meter& spec, LoadContext& context) {
  const bool point = std::holds_alternative<spec::PointProbe>(spec.probe.surface);
  const bool needs_surface =
      spec.measures == MeterQuantity::flux || spec.measures == MeterQuantity::intensity;
  const char* name = kMeterQuantityNames.at(static_cast<std::size_t>(spec.measures));
  if (point && needs_surface)
    context.diagnostics.error(spec.where,
                              fmt::format("a point has no area: its {} needs a quad, disc or sphere", name));
  const bool needs_cone =
      spec.measures == MeterQuantity::radiance || spec.measures == MeterQuantity::intensity;
  if (needs_cone && !spec.probe.acceptance_deg)
    context.diagnostics.error(
        spec.where, fmt::format("a meter of {} needs an acceptance_deg, the half-angle of its cone", name));
  if (spec.cells && !std::holds_alternative<spec::Quad>(spec.probe.surface))
    context.diagnostics.error(spec.cells->where, "cells need a quad");
}

}  // namespace

std::optional<IrradianceProbe> build(const spec::Probe& probe, const LoadContext& context) {
  const double degrees = probe.acceptance_deg.value_or(90);
  const double acceptance = degrees < 90 ? std::sin(degrees * std::numbers::pi / 180) : 1;
  if (const auto* point = std::get_if<spec::PointProbe>(&probe.surface))
    return IrradianceProbe{ProbePoint{point->at * context.unit_m, point->normal.normalized()}, acceptance};
  if (const auto* disc = std::get_if<spec::Disc>(&probe.surface))
    return IrradianceProbe{build(*disc, context), acceptance};
  if (const auto* side = std::get_if<spec::SphereProbe>(&probe.surface))
    return IrradianceProbe{SphereSide{build(side->sphere, context), side->facing == spec::Facing::inwards},
                           acceptance};
  const auto quad = build(std::get<spec::Quad>(probe.surface), context);
  return quad ? std::optional(IrradianceProbe{*quad, acceptance}) : std::nullopt;
}

std::vector<Meter> build(const spec::Meters& meters, LoadContext& context) {
  std::vector<Meter> built;
  for (const auto& [name, spec, where] : meters) {
    if (std::holds_alternative<std::monostate>(spec.probe.surface))
      continue;  // Reported when the file was read.
    check(spec, context);
    const auto probe = build(spec.probe, context);
    const auto bins = spec.spectrum ? build_bins(*spec.spectrum, context) : std::nullopt;
    if (!probe) continue;
    std::array<int, 2> cells{1, 1};
    if (spec.cells) cells = {static_cast<int>(spec.cells->value[0]), static_cast<int>(spec.cells->value[1])};
    built.push_back({name, spec.measures, *probe, cells, bins});
  }
  return built;
}

}  // namespace abbe::description
