#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "calibration/chart/patches.h"
#include "calibration/fit/correction.h"
#include "spectral/matrix3.h"

namespace abbe {

/// What a fit makes small.
enum class Objective {
  delta_e_2000,  ///< The mean CIEDE2000 over the patches.
  delta_e_76,    ///< The mean distance in L*a*b*.
  xyz,           ///< The squared error of XYZ.
};

/// The unconstrained matrix from white-balanced raw values to XYZ that minimises the squared XYZ error over
/// the patches. Throws Error{input} when the patches do not span three dimensions.
[[nodiscard]] Matrix3 least_squares_matrix(const PatchColors& colors);

/// The correction of any model with the least sum of squared XYZ errors, under the constraint that raw values
/// (1, 1, 1) map to the white exactly.
[[nodiscard]] ColorCorrection white_preserving_least_squares(const PatchColors& colors,
                                                             CorrectionModel model = CorrectionModel::linear);

/// Colour differences of each patch between the corrected raw values and the truth, relative to the
/// illuminant's white.
struct PatchErrors {
  std::vector<double> delta_e;  ///< CIEDE2000.
  double mean = 0;
  double max = 0;
  std::vector<double> delta_e_76;  ///< Distances in L*a*b*.
  double mean_76 = 0;              ///< Their mean.
};
[[nodiscard]] PatchErrors patch_errors(const PatchColors& colors, const ColorCorrection& correction);

/// A fitted correction with the account of its fit.
struct CorrectionFit {
  ColorCorrection correction;
  PatchErrors errors;       ///< Of the result.
  PatchErrors start;        ///< Of the white-preserving least-squares correction the fit began from.
  double initial_cost = 0;  ///< Half the sum of the losses at that start.
  double final_cost = 0;
  int starts = 0;  ///< How many starts were tried.
  int usable = 0;  ///< How many of them reached the tolerance with a finite solution; never none.
};

/// How a correction is fitted.
struct CorrectionOptions {
  CorrectionModel model = CorrectionModel::linear;
  Objective objective = Objective::delta_e_2000;
  int starts = 16;      ///< The least-squares start and jittered copies of it.
  double jitter = 0.1;  ///< Standard deviation of the jitter of each coefficient.
  std::uint64_t seed = 1;
  /// The most iterations made from each start. A sum of absolute errors approaches its minimum by a nearly
  /// constant factor per step, as slowly as 0.97 for ideal filters, so a fit may need hundreds of them.
  int max_iterations = 2000;
};

/// Whether there are four patches for each term of a root polynomial, or any for a matrix.
[[nodiscard]] bool are_enough_patches(CorrectionModel model, std::size_t patches);

/// Throws Error{usage} with the reason when `patches` are too few for a root polynomial: fewer than four for
/// each term, with which the terms follow the patches instead of the camera.
void require_enough_patches(CorrectionModel model, std::size_t patches);

/// The white-preserving correction that minimises the objective over the patches, the last term's column
/// following from the white. For a mean colour difference the loss of a patch is 2 a^2 (sqrt(1 + dE^2/a^2) -
/// 1) with a = 0.05, an absolute error that is smooth at zero; for XYZ the least-squares start is the answer.
/// Patches count by their weights. The result is never worse in the objective than its start. Throws
/// Error{input} when no start reaches the tolerance: a cost that changes by less than 1e-10 of itself.
[[nodiscard]] CorrectionFit fit_correction(const PatchColors& colors, const CorrectionOptions& options = {});

}  // namespace abbe
