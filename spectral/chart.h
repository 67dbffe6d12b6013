#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/diagnostics.h"
#include "io/table.h"
#include "spectral/curve.h"
#include "spectral/curve_use.h"

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

/// The table of a chart: one of `data/reflectance` or a user's file.
[[nodiscard]] std::optional<Table> read_chart_table(const std::string& name, const SourcePosition& where,
                                                    Diagnostics& diagnostics);
/// Whether a table is one of reflectances over wavelength; other editions of charts state colours.
[[nodiscard]] bool is_spectral(const Table& table);

/// The chart of a table of reflectances, one patch per column, e.g. "colorchecker24_babelcolor_average".
/// Reports a table of colours, one whose unit is not that of the use, one that says nothing of wavelengths
/// that are needed, and a patch with values beyond the use.
[[nodiscard]] std::optional<Chart> load_chart(const std::string& name, const SourcePosition& where,
                                              Diagnostics& diagnostics,
                                              const CurveUse& use = kReflectanceFactorUse,
                                              NeededRange needed = {});
/// The same of a shipped table; what is wrong with it is thrown as Error.
[[nodiscard]] Chart shipped_chart(const std::string& name);

}  // namespace abbe
