#pragma once

#include <optional>
#include <variant>

#include "description/load_context.h"
#include "description/surface.h"
#include "io/schema/fields.h"
#include "scene/camera/probe.h"

namespace abbe::spec {

struct PointProbe {
  Imath::V3d at{0, 0, 0};
  Imath::V3d normal{0, 0, 0};
};
/// The side from which a sphere receives light.
enum class Facing { outwards, inwards };
struct SphereProbe {
  Sphere sphere;
  Facing facing = Facing::outwards;
};
/// A surface that receives light within an angle of its normal.
struct Probe {
  std::variant<std::monostate, PointProbe, Quad, Disc, SphereProbe> surface;
  std::optional<double> acceptance_deg;
};
[[nodiscard]] schema::Fields fields(schema::Tag<Probe>);

}  // namespace abbe::spec

namespace abbe::description {

/// Builds a probe, with lengths in metres. Returns nothing after an error: parallel edges of a quad.
[[nodiscard]] std::optional<IrradianceProbe> build(const spec::Probe& probe, const LoadContext& context);

}  // namespace abbe::description
