#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibration/chart/patches.h"

namespace abbe {

/// What an observer sees of a chart's patches under one light.
struct ChartTargets {
  std::vector<std::string> names;
  std::vector<XYZ> xyz;  ///< Y = 1 for the perfect diffuser.
  XYZ white;             ///< The perfect diffuser.
};

/// The colours of a chart: of a table of reflectances under `illuminant` for the CIE 1931 observer, or as an
/// edition's table states them (columns `patch` and `x`, `y`, `Y` or `L`, `a`, `b`, and a line `# white_xy:
/// x, y`) under its own light, whatever `illuminant` is.
[[nodiscard]] std::optional<ChartTargets> load_chart_targets(const std::string& name, const Curve& illuminant,
                                                             const SourcePosition& where,
                                                             Diagnostics& diagnostics);

/// A camera's values of named patches, each named once, from a table with the columns `patch`, `R`, `G`, `B`.
struct MeasuredPatches {
  std::vector<std::string> names;
  std::vector<Raw> values;
};
[[nodiscard]] std::optional<MeasuredPatches> load_measured_patches(const std::filesystem::path& path,
                                                                   Diagnostics& diagnostics);

/// Linear measured values beside the colours of their chart, white balanced.
struct BalancedPatches {
  PatchColors colors;
  std::array<double, 3> gains;  ///< What balanced them.
};

/// Balances on the patch named "perfect diffuser" if there is one, else on the value of the perfect diffuser
/// that fits the chart's neutral patches (chroma below 5) best, in proportion to their luminance. Every patch
/// of the chart must have been measured. Throws Error{input} naming those that are missing, and when there is
/// nothing to balance on.
[[nodiscard]] BalancedPatches balance(const ChartTargets& chart, const MeasuredPatches& measured);

}  // namespace abbe
