#pragma once

#include <array>
#include <optional>
#include <vector>

#include "description/load_context.h"
#include "io/schema/fields.h"
#include "scene/shutter.h"

namespace abbe::spec {

/// When and how far the rows of a sensor are open.
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

/// The shutter of a sensor of so many rows. Reports what no table can say; then it is wide open.
[[nodiscard]] Shutter build(const spec::Shutter& said, double exposure_s, int rows,
                            const LoadContext& context);

}  // namespace abbe::description
