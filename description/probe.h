#pragma once

#include <optional>
#include <variant>

#include "description/load_context.h"
#include "description/surface.h"
#include "io/schema/fields.h"
#include "scene/camera/probe.h"

namespace abbe::spec {

// Irradiance probes as scene files describe them. Lengths are in the scene file's unit. Probes are invisible
// to light.

/// A point that receives light from the side to which its normal points.
struct PointProbe {
  Imath::V3d at{0, 0, 0};      ///< Position.
  Imath::V3d normal{0, 0, 0};  ///< Direction that the point faces, of any length except 0.
};
/// The side from which a sphere receives light.
enum class Facing { outwards, inwards };
struct SphereProbe {
  Sphere sphere;
  Facing facing = Facing::outwards;
};
/// A surface that receives light within an angle of its normal. `std::monostate` means that none has been
/// read.
struct Probe {
  std::variant<std::monostate, PointProbe, Quad, Disc, SphereProbe> surface;
  std::optional<double> acceptance_deg;  ///< Largest angle to the normal, in [0.01, 90]; 90 if absent.
};
/// Key table by which scene files are read, written and documented.
[[nodiscard]] schema::Fields fields(schema::Tag<Probe>);

}  // namespace abbe::spec

namespace abbe::description {

/// Builds a probe, with lengths in metres. `probe.surface` must not be std::monostate. Reports parallel edges
/// of a quad to `context.diagnostics` and returns nothing then.
[[nodiscard]] std::optional<IrradianceProbe> build(const spec::Probe& probe, const LoadContext& context);

}  // namespace abbe::description
