#pragma once

#include <array>
#include <optional>
#include <vector>

#include "description/probe.h"
#include "description/sensor.h"
#include "scene/camera/meter.h"

namespace abbe::spec {

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

/// Builds the meters in the order of the file, with lengths in metres. A meter whose surface has an error is
/// left out. Reports to `context.diagnostics`:
/// - a flux or intensity of a point;
/// - cells of a surface that is not a quad;
/// - a radiance or intensity of a meter without an `acceptance_deg`;
/// - the errors of probes and of wavelength bins.
[[nodiscard]] std::vector<Meter> build(const spec::Meters& meters, LoadContext& context);

}  // namespace abbe::description
