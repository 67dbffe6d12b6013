#pragma once

#include <array>
#include <vector>

#include "calibration/chart/measured_patches.h"

namespace abbe {

/// Linear measured values beside the colours of their chart, white balanced.
struct BalancedPatches {
  PatchColors colors;
  std::array<double, 3> gains;       ///< What balanced them.
  std::vector<Raw> deviations = {};  ///< Standard deviations of the balanced values; empty: unknown.
};

/// Balances on the patch named "perfect diffuser" if there is one, else on the value of the perfect diffuser
/// that fits the chart's neutral patches (chroma below 5) best, in proportion to their luminance. Such
/// patches are not quite neutral: what their tinge does to the values, the least-squares matrix of all
/// patches tells, if they determine one. Every patch of the chart must have been measured, and no
/// other; those with saturated pixels are left out. Throws Error{input} naming one that is unknown, or those
/// that are missing, when less than half is left, and when there is nothing to balance on.
[[nodiscard]] BalancedPatches balance(const ChartTargets& chart, const MeasuredPatches& measured);

}  // namespace abbe
