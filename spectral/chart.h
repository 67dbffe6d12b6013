#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/diagnostics.h"
#include "spectral/curve.h"

namespace abbe {

/// One patch of a colour chart.
struct Patch {
  std::string name;
  Curve reflectance;
};

/// A chart: named patches in the order of its table.
struct Chart {
  std::string name;
  std::vector<Patch> patches;
};

/// The chart of one table of `data/reflectance` (or of a user's file), one patch per column, e.g.
/// "colorchecker24_babelcolor_average".
[[nodiscard]] std::optional<Chart> load_chart(const std::string& name, const SourcePosition& where,
                                              Diagnostics& diagnostics);

}  // namespace abbe
