#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "calibration/fit/correction.h"

namespace abbe {

/// Median of `values`, which must not be empty; for an even number, the mean of the central two.
[[nodiscard]] double median(std::vector<double> values);

/// The 95 % interval of an estimate, in the unit of the estimate.
struct Interval {
  double low = 0;
  double high = 0;
};

/// Error of each patch under a correction that was fitted without it, in the order of the patches. The
/// patches are dealt to `folds` groups in turn, and each group is predicted by the fit to all others, from at
/// most two starts. One patch is left out at a time if there are as many folds as patches. Throws
/// Error{usage} unless `folds` is between 2 and the number of patches, Error{input} if a fit fails.
[[nodiscard]] PatchErrors cross_validate(const PatchColors& colors, const CorrectionOptions& options,
                                         std::size_t folds);

/// A correction model with its cross-validation error.
struct ModelCandidate {
  CorrectionModel model;
  double unseen_mean;  ///< Mean CIEDE2000 by `cross_validate`.
};

/// Compares all models that have enough patches, by the mean error of `cross_validate`. The first of the
/// result is the best: the one with the fewest terms among those within 0.01 of the least error. The others
/// follow by rising error. If `folds` is 0, there are as many folds as patches, at most 24.
[[nodiscard]] std::vector<ModelCandidate> cross_validate_models(const PatchColors& colors,
                                                                const CorrectionOptions& options,
                                                                std::size_t folds);

/// 95 % percentile interval of the mean of `values`, by bootstrap [Efron1993]: they are drawn with
/// replacement `draws` times, at least once. They must not be empty.
[[nodiscard]] Interval bootstrap_mean(std::span<const double> values, int draws);

/// 95 % percentile intervals of a correction's columns: those of X, Y and Z for each term. The patches are
/// drawn with replacement and the correction is fitted to each draw, from at most two starts. A draw whose
/// fit fails is repeated. Throws the Error{input} of such a fit if more draws fail than are requested.
[[nodiscard]] std::vector<std::array<Interval, 3>> bootstrap_columns(const PatchColors& colors,
                                                                     const CorrectionOptions& how, int draws);

}  // namespace abbe
