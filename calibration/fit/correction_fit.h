#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "calibration/chart/patches.h"
#include "calibration/fit/correction.h"
#include "spectral/matrix3.h"

namespace abbe {

/// Objective that a fit minimises.
enum class Objective {
  delta_e_2000,  ///< The mean CIEDE2000 over the patches.
  delta_e_76,    ///< The mean distance in L*a*b*.
  xyz,           ///< The squared error of XYZ.
};

/// Matrix from white-balanced raw values to XYZ with the least squared XYZ error over the patches, without
/// constraints. Throws Error{input} if the patches do not span three dimensions.
[[nodiscard]] Matrix3 least_squares_matrix(const PatchColors& colors);

/// Correction of any model with the least sum of squared XYZ errors, under the constraint that raw values (1,
/// 1, 1) map exactly to the white. Patches count by their weights. Throws Error{input} if the patches do not
/// determine it.
[[nodiscard]] ColorCorrection white_preserving_least_squares(const PatchColors& colors,
                                                             CorrectionModel model = CorrectionModel::linear);

/// Colour differences of each patch between corrected raw values and true colour, relative to the
/// illuminant's white.
struct PatchErrors {
  std::vector<double> delta_e;  ///< CIEDE2000.
  double mean = 0;
  double max = 0;
  std::vector<double> delta_e_76;  ///< Distances in L*a*b*.
  double mean_76 = 0;              ///< Their mean.
};
[[nodiscard]] PatchErrors patch_errors(const PatchColors& colors, const ColorCorrection& correction);

/// A fitted correction with a report of the fit.
struct CorrectionFit {
  ColorCorrection correction;
  PatchErrors errors;  ///< Errors of `correction`.
  PatchErrors start;  ///< Errors of the white-preserving least-squares correction, from which the fit starts.
  double initial_cost = 0;  ///< Half the sum of the losses at that start.
  double final_cost = 0;
  int starts = 0;  ///< Number of starts that were tried.
  int usable = 0;  ///< Number of starts that reached the tolerance with a finite solution; at least 1.
};

/// Options of a correction fit.
struct CorrectionOptions {
  CorrectionModel model = CorrectionModel::linear;
  Objective objective = Objective::delta_e_2000;
  int starts = 16;  ///< Number of starts: the least-squares correction and randomly displaced copies of it.
  double jitter = 0.1;  ///< Standard deviation of the displacement of each coefficient.
  std::uint64_t seed = 1;
  /// Maximum number of iterations from each start. A sum of absolute errors approaches its minimum by a
  /// nearly constant factor per step, as slowly as 0.97 for ideal filters. A fit may therefore need hundreds
  /// of iterations.
  int max_iterations = 2000;
};

/// True if there are at least four patches for each term of a root polynomial. True for any number with a
/// matrix.
[[nodiscard]] bool are_enough_patches(CorrectionModel model, std::size_t patches);

/// Throws Error{usage} if there are fewer than four patches for each term of a root polynomial: its terms
/// would then follow the patches instead of the camera.
void require_enough_patches(CorrectionModel model, std::size_t patches);

/// White-preserving correction that minimises the objective over the patches. The last term's column follows
/// from the white. Patches count by their weights.
///
/// For a mean colour difference, the loss of a patch is 2 a^2 (sqrt(1 + dE^2/a^2) - 1) with a = 0.05, an
/// absolute error that is smooth at zero. For XYZ, the least-squares start is the answer. The result is never
/// worse in the objective than its start. Throws Error{input} if no start converges to a relative change of
/// the cost below 1e-10.
[[nodiscard]] CorrectionFit fit_correction(const PatchColors& colors, const CorrectionOptions& options = {});

}  // namespace abbe
