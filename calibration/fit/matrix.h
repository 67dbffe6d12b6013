#pragma once

#include <cstdint>
#include <vector>

#include "calibration/chart/matrix3.h"
#include "calibration/chart/patches.h"

namespace abbe {

/// The unconstrained matrix from white-balanced raw values to XYZ that minimises the squared XYZ error over
/// the patches. Throws Error{input} when the patches do not span three dimensions.
[[nodiscard]] Matrix3 least_squares_matrix(const PatchColors& colors);

/// The same under the constraint that (1, 1, 1) maps to the white exactly.
[[nodiscard]] Matrix3 white_preserving_least_squares(const PatchColors& colors);

/// CIEDE2000 of each patch between the corrected raw values and the truth, relative to the illuminant's
/// white.
struct PatchErrors {
  std::vector<double> delta_e;
  double mean = 0;
  double max = 0;
};
[[nodiscard]] PatchErrors patch_errors(const PatchColors& colors, const Matrix3& raw_to_xyz);

/// A fitted matrix with the account of its fit.
struct MatrixFit {
  Matrix3 raw_to_xyz;   ///< White-balanced raw to XYZ, Y = 1 for the perfect diffuser.
  PatchErrors errors;   ///< Of the result.
  PatchErrors start;    ///< Of the white-preserving least-squares matrix the fit began from.
  double initial_cost;  ///< Half the sum of the losses at that start.
  double final_cost;
  int starts;  ///< How many starts were tried.
  int usable;  ///< How many of them converged to a finite, usable solution.
};

/// How the matrix is fitted.
struct MatrixFitOptions {
  int starts = 16;      ///< The least-squares start and jittered copies of it.
  double jitter = 0.1;  ///< Standard deviation of the jitter of each coefficient.
  std::uint64_t seed = 1;
  int max_iterations = 200;
};

/// The white-preserving matrix that minimises the mean CIEDE2000 over the patches: six parameters, the last
/// column following from the white; per patch the loss 2 a^2 (sqrt(1 + dE^2/a^2) - 1) with a = 0.05, a mean
/// absolute error that is smooth at zero. The result is never worse in the mean than its start. Throws
/// Error{input} when no start converges, with the solver's own report.
[[nodiscard]] MatrixFit fit_matrix(const PatchColors& colors, const MatrixFitOptions& options = {});

}  // namespace abbe
