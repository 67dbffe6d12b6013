#include "description/probe.h"

#include <cmath>
#include <numbers>

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

}  // namespace abbe::spec

namespace abbe::description {

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

}  // namespace abbe::description
