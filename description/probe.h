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
/// From which side light comes to a sphere.
enum class Facing { outwards, inwards };
struct SphereProbe {
  Sphere sphere;
  Facing facing = Facing::outwards;
};
/// A surface that takes light within some angle of its normal.
struct Probe {
  std::variant<std::monostate, PointProbe, Quad, Disc, SphereProbe> surface;
  std::optional<double> acceptance_deg;
};
[[nodiscard]] schema::Fields fields(schema::Tag<Probe>);

}  // namespace abbe::spec

namespace abbe::description {

/// The meter in metres. Reports parallel edges; nothing then.
[[nodiscard]] std::optional<Probe> build(const spec::Probe& probe, const LoadContext& context);

}  // namespace abbe::description
