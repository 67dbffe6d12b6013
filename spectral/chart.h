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

/// A colour chart: named patches in the order of its table.
struct Chart {
  std::string name;
  std::vector<Patch> patches;
};

/// Reads the table of a chart: one of `data/reflectance` or a user's file.
[[nodiscard]] std::optional<Table> read_chart_table(const std::string& name, const SourcePosition& where,
                                                    Diagnostics& diagnostics);
/// True if the table contains reflectances over wavelength. Other editions of charts contain colours.
[[nodiscard]] bool is_spectral(const Table& table);

/// Reads the chart of a table of reflectances, one patch per column, such as
/// "colorchecker24_babelcolor_average". Reports a table of colours, a unit or values that `use` does not
/// allow, and a table that does not cover `needed`.
[[nodiscard]] std::optional<Chart> load_chart(const std::string& name, const SourcePosition& where,
                                              Diagnostics& diagnostics,
                                              const CurveUse& use = kReflectanceFactorUse,
                                              NeededRange needed = {});
/// Reads the chart of a shipped table. Throws Error if the table is faulty.
[[nodiscard]] Chart shipped_chart(const std::string& name);

}  // namespace abbe
