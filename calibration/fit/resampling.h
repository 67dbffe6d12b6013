#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "calibration/fit/correction_fit.h"

namespace abbe {

/// The 95 % interval of an estimate.
struct Interval {
  double low = 0;
  double high = 0;
};

/// Error of each patch under a correction that was fitted without it. The patches are dealt to `folds` groups
/// in turn, and each group is predicted by the fit to all others. As many folds as patches leave one out at a
/// time. Throws Error{usage} unless `folds` is between 2 and the number of patches.
[[nodiscard]] PatchErrors cross_validate(const PatchColors& colors, const CorrectionOptions& options,
                                         std::size_t folds);

/// A correction model with its cross-validation error.
struct ModelCandidate {
  CorrectionModel model;
  double unseen_mean;  ///< Mean CIEDE2000 by `cross_validate`.
};

/// Compares all models that have enough patches, by the mean error of `cross_validate`. The first of the
/// result is the best: the one with the fewest terms among those within 0.01 of the least error. The others
/// follow by error. With `folds` = 0, there are as many folds as patches, at most 24.
[[nodiscard]] std::vector<ModelCandidate> cross_validate_models(const PatchColors& colors,
                                                                const CorrectionOptions& options,
                                                                std::size_t folds);

/// Options of a bootstrap [Efron1993].
struct BootstrapOptions {
  int replicates = 200;
  std::uint64_t seed = 1;
};

/// Percentile interval of the mean of `values`, drawn with replacement.
[[nodiscard]] Interval bootstrap_mean(std::span<const double> values, const BootstrapOptions& options = {});

/// Percentile intervals of a correction's columns (the XYZ of each term). The patches are drawn with
/// replacement and the correction is fitted to each draw. A draw that does not determine the correction is
/// repeated.
[[nodiscard]] std::vector<std::array<Interval, 3>> bootstrap_columns(const PatchColors& colors,
                                                                     const CorrectionOptions& how,
                                                                     const BootstrapOptions& options = {});

}  // namespace abbe
