#pragma once

#include <array>
#include <vector>

#include "calibration/chart/measured_patches.h"

namespace abbe {

/// Linear, white-balanced measured values with the colours of their chart, in its order without excluded
/// patches.
struct BalancedPatches {
  PatchColors colors;
  /// Factors from the measured to the balanced values, in the order R, G, B.
  std::array<double, 3> gains;
  /// Standard deviations of the balanced values, one per patch of `colors`; empty: unknown.
  std::vector<Raw> deviations = {};
};

/// Balances measured values on the patch named "perfect diffuser", if there is one. Otherwise it uses the
/// value of the perfect diffuser that best fits the chart's neutral patches (chroma below 5), weighted by
/// luminance. These patches are not exactly neutral. The least-squares matrix of all patches corrects for
/// their tinge if the patches determine one.
///
/// Every patch of the chart must have been measured, and no other. Patches with saturated pixels are
/// excluded. Throws Error{input} for an unknown patch and for missing ones, with their names. Throws it also
/// if less than half of the patches remain, and if there is nothing to balance on.
[[nodiscard]] BalancedPatches balance(const ChartTargets& chart, const MeasuredPatches& measured);

}  // namespace abbe
