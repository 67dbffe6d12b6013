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

/// The error of each patch under a correction fitted to other patches alone: the patches are dealt to `folds`
/// groups in turn, and each group is shown by the fit to the rest. As many folds as patches leaves one out at
/// a time. Throws Error{usage} unless there are 2 folds to as many as patches.
[[nodiscard]] PatchErrors cross_validate(const PatchColors& colors, const CorrectionOptions& options,
                                         std::size_t folds);

/// A model and how it shows patches that its fit has not seen.
struct ModelCandidate {
  CorrectionModel model;
  double unseen_mean;  ///< Mean CIEDE2000 by `cross_validate`.
};

/// The models that there are enough patches for, the best first (of those within 0.01 of it the one with
/// fewest terms), then by error: by `cross_validate` with `folds` groups, or with as many as patches, at most
/// 24, for 0.
[[nodiscard]] std::vector<ModelCandidate> cross_validate_models(const PatchColors& colors,
                                                                const CorrectionOptions& options,
                                                                std::size_t folds);

/// How a bootstrap draws [Efron1993].
struct BootstrapOptions {
  int replicates = 200;
  std::uint64_t seed = 1;
};

/// Percentile interval of the mean of `values`, which are drawn with replacement.
[[nodiscard]] Interval bootstrap_mean(std::span<const double> values, const BootstrapOptions& options = {});

/// Percentile intervals of the columns of a correction (the XYZ of each term) when the patches are drawn with
/// replacement and the correction fitted anew. A draw that does not determine it is drawn again.
[[nodiscard]] std::vector<std::array<Interval, 3>> bootstrap_columns(const PatchColors& colors,
                                                                     const CorrectionOptions& how,
                                                                     const BootstrapOptions& options = {});

}  // namespace abbe
