#pragma once

#include <array>
#include <optional>
#include <vector>

#include "description/load_context.h"
#include "io/schema/fields.h"
#include "scene/shutter.h"

namespace abbe::spec {

/// Times and transmission of the shutter of each row of a sensor.
struct Shutter {
  double open_s = 0;
  double rise_s = 0;
  double fall_s = 0;
  std::optional<schema::Located<std::vector<std::array<double, 2>>>> transmission;
  double row_delay_s = 0;
  SourcePosition where;
};
[[nodiscard]] schema::Fields fields(schema::Tag<Shutter>);

}  // namespace abbe::spec

namespace abbe::description {

/// Builds the shutter of a sensor with `rows` rows. After an error it is fully open for the exposure time.
[[nodiscard]] Shutter build(const spec::Shutter& spec, double exposure_s, int rows,
                            const LoadContext& context);

}  // namespace abbe::description
