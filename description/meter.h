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
  std::optional<schema::Located<std::array<std::int64_t, 2>>> cells;
  std::optional<Bins> spectrum;
  SourcePosition where;
};
using Meters = std::vector<schema::Named<Meter>>;
[[nodiscard]] schema::Fields fields(schema::Tag<Meter>);

}  // namespace abbe::spec

namespace abbe::description {

/// Builds the meters, with lengths in metres. Reports:
/// - a flux or intensity of a point;
/// - cells of a surface that is not a quad;
/// - a radiance or intensity of a meter that accepts light from a whole hemisphere.
[[nodiscard]] std::vector<Meter> build(const spec::Meters& meters, LoadContext& context);

}  // namespace abbe::description
