#pragma once

#include <array>
#include <optional>
#include <vector>

#include "description/load_context.h"
#include "io/schema/fields.h"
#include "scene/shutter.h"

namespace abbe::spec {

/// Times and transmission of the shutter of each row of a sensor. A row is open for the exposure time of the
/// sensor.
struct Shutter {
  double open_s = 0;  ///< Time at which the first row opens, on the clock of keyframes.
  double rise_s = 0;  ///< Duration of opening, at a constant rate, as part of the exposure time.
  double fall_s = 0;  ///< Duration of closing, at a constant rate, as part of the exposure time.
  /// Pairs of the elapsed fraction of the exposure time, ascending from 0 to 1, and the transmittance in [0,
  /// 1] at that time, linearly interpolated. It replaces `rise_s` and `fall_s`, which must then be 0.
  std::optional<schema::Located<std::vector<std::array<double, 2>>>> transmission;
  double row_delay_s = 0;  ///< Delay of each row after the row above it, 0 or more.
  SourcePosition where;
};
/// Key table by which scene files are read, written and documented.
[[nodiscard]] schema::Fields fields(schema::Tag<Shutter>);

}  // namespace abbe::spec

namespace abbe::description {

/// Builds the shutter of a sensor with `rows` rows and the exposure time `exposure_s` > 0, with times as
/// fractions of it. Reports to `context.diagnostics`:
/// - both a transmission and a rise or fall;
/// - a rise and fall that together exceed the exposure time;
/// - a transmission whose fractions decrease or do not run from 0 to 1, or that passes no light.
/// After an error the shutter is fully open for the exposure time, without a row delay.
[[nodiscard]] Shutter build(const spec::Shutter& spec, double exposure_s, int rows,
                            const LoadContext& context);

}  // namespace abbe::description
