#include "description/meter.h"

#include <fmt/format.h>

#include "description/kinds.h"

namespace abbe::spec {

using namespace schema;

Fields fields(Tag<Meter>) {
  return describe(
      "meter", "What measures light, for `abbe meter`.",
      {defaulted(
           "measures", &Meter::measures,
           word<MeterQuantity>("quantity", {"irradiance", "flux", "radiance", "intensity"}),
           "What it tells of the light that counts: the irradiance of its surface; the flux through it; "
           "the mean radiance of the cone of `acceptance_deg`; the flux through it per solid angle of "
           "that cone."),
       lent(&Meter::probe),
       field("cells", &Meter::cells, vector<std::array<std::int64_t, 2>>(Range{1, 256}),
             "Parts of a quad along edge_u and edge_v, which are told too."),
       field("spectrum", &Meter::spectrum, "In which bins of wavelength it also tells the light.")});
}

}  // namespace abbe::spec

namespace abbe::description {
namespace {

// What no table can say.
void check(const spec::Meter& said, LoadContext& context) {
  const bool point = std::holds_alternative<spec::PointProbe>(said.probe.surface);
  const bool whole = said.measures == MeterQuantity::flux || said.measures == MeterQuantity::intensity;
  const char* name = kMeterQuantityNames.at(static_cast<std::size_t>(said.measures));
  if (point && whole)
    context.diagnostics.error(
        said.where, fmt::format("no light goes through a point: its {} needs a quad, disc or sphere", name));
  const bool of_a_cone =
      said.measures == MeterQuantity::radiance || said.measures == MeterQuantity::intensity;
  if (of_a_cone && !said.probe.acceptance_deg)
    context.diagnostics.error(
        said.where, fmt::format("a meter of {} takes light from a cone: it needs an acceptance_deg", name));
  if (said.cells && !std::holds_alternative<spec::Quad>(said.probe.surface))
    context.diagnostics.error(said.cells->where, "cells are parts of a quad");
}

}  // namespace

std::vector<Meter> build(const spec::Meters& meters, LoadContext& context) {
  std::vector<Meter> built;
  for (const auto& [name, said, where] : meters) {
    if (std::holds_alternative<std::monostate>(said.probe.surface)) continue;  // told already
    check(said, context);
    const auto probe = build(said.probe, context);
    const auto bins = said.spectrum ? build_bins(*said.spectrum, context) : std::nullopt;
    if (!probe) continue;
    std::array<int, 2> cells{1, 1};
    if (said.cells) cells = {static_cast<int>(said.cells->value[0]), static_cast<int>(said.cells->value[1])};
    built.push_back({name, said.measures, *probe, cells, bins});
  }
  return built;
}

}  // namespace abbe::description
