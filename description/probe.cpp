#include "description/probe.h"

#include <cmath>
#include <numbers>

#include "description/kinds.h"

namespace abbe::spec {

using namespace schema;

static Fields fields(Tag<PointProbe>) {
  return describe("point_probe", "",
                  {field("at", &PointProbe::at, kCoordinate, "Position of a point that measures."),
                   field("normal", &PointProbe::normal, direction(), "Direction the point faces.")});
}

static Fields fields(Tag<SphereProbe>) {
  return describe("sphere_probe", "A sphere that measures.",
                  {lent(&SphereProbe::sphere),
                   defaulted("facing", &SphereProbe::facing, word<Facing>("side", {"outwards", "inwards"}),
                             "Whether it takes the light that comes from without, or from within.")});
}

Fields fields(Tag<Probe>) {
  return describe(
      "probe", "A surface that measures the light which comes to it, and is in no light's way.",
      {one_of(&Probe::surface, beside<PointProbe>("at"),
              under<Quad>("quad",
                          "A parallelogram that measures, one patch per pixel; it faces edge_u x edge_v."),
              under<Disc>("disc", "A disc that measures on the side of its normal."),
              under<SphereProbe>("sphere")),
       field("acceptance_deg", &Probe::acceptance_deg, Range{0.01, 90}.in("degrees"),
             "Greatest angle with the normal under which light counts: 90, for all of its side, when "
             "absent.")});
}

}  // namespace abbe::spec

namespace abbe::description {

std::optional<Probe> build(const spec::Probe& probe, const LoadContext& context) {
  const double degrees = probe.acceptance_deg.value_or(90);
  const double acceptance = degrees < 90 ? std::sin(degrees * std::numbers::pi / 180) : 1;
  if (const auto* point = std::get_if<spec::PointProbe>(&probe.surface))
    return Probe{PointOfMeter{point->at * context.unit_m, point->normal.normalized()}, acceptance};
  if (const auto* disc = std::get_if<spec::Disc>(&probe.surface))
    return Probe{build(*disc, context), acceptance};
  if (const auto* side = std::get_if<spec::SphereProbe>(&probe.surface))
    return Probe{SphereSide{build(side->sphere, context), side->facing == spec::Facing::inwards}, acceptance};
  const auto quad = build(std::get<spec::Quad>(probe.surface), context);
  return quad ? std::optional(Probe{*quad, acceptance}) : std::nullopt;
}

}  // namespace abbe::description
