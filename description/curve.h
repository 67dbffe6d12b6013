#pragma once

#include <optional>
#include <string_view>

#include "description/values.h"

namespace abbe::description {

/// Where a curve is used: the data folder its names are looked for in, and the values it may take.
struct CurveUse {
  std::string_view folder;
  Range allowed = kValue;
};
[[nodiscard]] std::optional<Curve> read_curve(const JsonValue& json, const CurveUse& use,
                                              LoadContext& context);
/// The curves an emission shares with other curves: "blackbody_K", "daylight_K" and "lines".
[[nodiscard]] std::optional<Curve> read_source(std::string_view key, const JsonValue& json,
                                               LoadContext& context);

}  // namespace abbe::description
