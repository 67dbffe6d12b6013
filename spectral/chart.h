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
  Curve reflectance;  ///< Reflectance, as a fraction of 1; above 1 for glossy or fluorescent patches.
};

/// A colour chart: named patches in the order of its table.
struct Chart {
  std::string name;
  std::vector<Patch> patches;  ///< In the order of the columns.
};

/// Reads the table of a chart: one of `data/reflectance` or a user's file, named as for `find_table`.
[[nodiscard]] std::optional<Table> read_chart_table(const std::string& name, const SourcePosition& where,
                                                    Diagnostics& diagnostics);
/// True if the table contains reflectances over wavelength. Other editions of charts contain colours.
[[nodiscard]] bool is_spectral(const Table& table);

/// Reads the chart of a table of reflectances, one patch per column. The folder of `use` must be
/// "reflectance". Reports errors and returns nothing for a table of colours, a unit or values that `use` does
/// not allow, and a column that `load_curve` rejects.
[[nodiscard]] std::optional<Chart> load_chart(const std::string& name, const SourcePosition& where,
                                              Diagnostics& diagnostics,
                                              const CurveUse& use = kReflectanceFactorUse,
                                              NeededRange needed = {});
/// Reads the chart of a shipped table. Throws Error, with the code of the first report of `load_chart`.
[[nodiscard]] Chart shipped_chart(const std::string& name);

}  // namespace abbe
