#pragma once

#include <array>
#include <optional>
#include <vector>

#include "description/probe.h"
#include "description/sensor.h"
#include "scene/camera/meter.h"

namespace abbe::spec {

/// A meter by what it tells.
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

/// The meters in metres. Reports quantities that a point has none of, cells of what is no quad, and radiances
/// and intensities of meters that take light from all sides.
[[nodiscard]] std::vector<Meter> build(const spec::Meters& meters, LoadContext& context);

}  // namespace abbe::description
