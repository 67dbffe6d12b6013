#pragma once

#include <array>
#include <optional>
#include <variant>
#include <vector>

#include "description/load_context.h"
#include "description/sensor.h"
#include "description/surface.h"
#include "io/schema/fields.h"
#include "scene/camera/meter.h"
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

/// A meter: a probe and the quantity that it reports.
struct Meter {
  MeterQuantity measures = MeterQuantity::irradiance;
  Probe probe;
  /// Number of cells of a quad along edge_u and edge_v, from 1 to 256 each, which are reported too. One if
  /// absent.
  std::optional<schema::Located<std::array<std::int64_t, 2>>> cells;
  std::optional<Bins> spectrum;  ///< Wavelength bins in which the quantity is reported too; none if absent.
  SourcePosition where;
};
using Meters = std::vector<schema::Named<Meter>>;
/// Key table by which scene files are read, written and documented.
[[nodiscard]] schema::Fields fields(schema::Tag<Meter>);

}  // namespace abbe::spec

namespace abbe::description {

/// Builds a probe, with lengths in metres. `probe.surface` must not be std::monostate. Reports parallel edges
/// of a quad to `context.diagnostics` and returns nothing then.
[[nodiscard]] std::optional<IrradianceProbe> build(const spec::Probe& probe, const LoadContext& context);

/// Builds the meters in the order of the file, with lengths in metres. A meter whose surface has an error is
/// left out. Reports to `context.diagnostics`:
/// - a flux or intensity of a point;
/// - cells of a surface that is not a quad;
/// - a radiance or intensity of a meter without an `acceptance_deg`;
/// - the errors of probes and of wavelength bins.
[[nodiscard]] std::vector<Meter> build(const spec::Meters& meters, LoadContext& context);

}  // namespace abbe::description
