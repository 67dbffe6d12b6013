#include "description/meter.h"

#include <fmt/format.h>

#include "description/value_ranges.h"

namespace abbe::spec {

using namespace schema;

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
