#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "calibration/chart/patches.h"
#include "spectral/matrix3.h"

namespace abbe {

/// Terms of the raw values that a colour correction adds up. All terms have degree 1, so a correction
/// commutes with exposure, and all are 1 at (1, 1, 1).
enum class CorrectionModel {
  linear,             ///< R, G, B: a matrix.
  root_polynomial_2,  ///< R, G, B and the square roots of RG, GB, RB [Finlayson2015].
  root_polynomial_3,  ///< The former six and the cube roots of RG^2, GB^2, RB^2, GR^2, BG^2, BR^2 and RGB.
};

/// Names of the models, in the order of `CorrectionModel`.
inline constexpr std::array kCorrectionNames{"matrix", "root-polynomial-2", "root-polynomial-3"};

[[nodiscard]] constexpr std::size_t term_count(CorrectionModel model) {
  return model == CorrectionModel::linear ? 3 : model == CorrectionModel::root_polynomial_2 ? 6 : 13;
}

/// Terms of white-balanced raw values, in the order of the comments of `CorrectionModel`. The root of a
/// negative product is zero.
[[nodiscard]] std::vector<double> correction_terms(CorrectionModel model, const Raw& raw);

/// Colour correction from white-balanced raw values to XYZ, with Y = 1 for the perfect diffuser.
struct ColorCorrection {
  CorrectionModel model = CorrectionModel::linear;
  std::vector<XYZ> columns;  ///< Contribution of each term, in the order of `correction_terms`.

  /// Sum of the columns times the terms of balanced values: XYZ relative to the light's white.
  [[nodiscard]] XYZ operator()(const Raw& raw) const;
};

[[nodiscard]] ColorCorrection linear_correction(const Matrix3& raw_to_xyz);

/// Matrix of the first three columns of a correction, which are all columns of a linear one.
[[nodiscard]] Matrix3 linear_part(const ColorCorrection& correction);

/// Objective that a fit minimises over the patches, which count by their weights (`PatchColors::weights`).
enum class Objective {
  delta_e_2000,  ///< The mean CIEDE2000 over the patches.
  delta_e_76,    ///< The mean distance in L*a*b*.
  xyz,           ///< The squared error of XYZ.
};

/// Matrix from white-balanced raw values to XYZ with the least squared XYZ error over the patches, without
/// constraints and without weights. Throws Error{input} if the patches do not span three dimensions.
[[nodiscard]] Matrix3 least_squares_matrix(const PatchColors& colors);

/// Correction of any model with the least sum of squared XYZ errors, under the constraint that raw values (1,
/// 1, 1) map exactly to the white. Patches count by their weights. Throws Error{input} if the patches do not
/// determine it.
[[nodiscard]] ColorCorrection white_preserving_least_squares(const PatchColors& colors,
                                                             CorrectionModel model = CorrectionModel::linear);

/// Colour differences between corrected raw values and true colours, relative to the illuminant's white.
struct PatchErrors {
  std::vector<double> delta_e;     ///< CIEDE2000 of each patch.
  double mean = 0;                 ///< Mean of `delta_e`, without weights.
  double max = 0;                  ///< Maximum of `delta_e`.
  std::vector<double> delta_e_76;  ///< Distance in L*a*b* of each patch.
  double mean_76 = 0;              ///< Mean of `delta_e_76`, without weights.
};
/// Errors of a correction on these patches; means and maximum are 0 without patches.
[[nodiscard]] PatchErrors patch_errors(const PatchColors& colors, const ColorCorrection& correction);

/// A fitted correction with a report of the fit.
struct CorrectionFit {
  ColorCorrection correction;
  PatchErrors errors;  ///< Errors of `correction`.
  PatchErrors start;  ///< Errors of the white-preserving least-squares correction, from which the fit starts.
  /// Half the weighted sum of the losses at that start; 0 for `Objective::xyz`.
  double initial_cost = 0;
  /// Half the weighted sum of the losses of `correction`; 0 for `Objective::xyz`.
  double final_cost = 0;
  int starts = 0;  ///< Number of starts that were tried.
  int usable = 0;  ///< Number of starts that reached the tolerance with a finite solution; at least 1.
};

/// Options of a correction fit.
struct CorrectionOptions {
  CorrectionModel model = CorrectionModel::linear;
  Objective objective = Objective::delta_e_2000;
  /// Number of starts: the least-squares correction and randomly displaced copies of it. At least 1.
  int starts = 16;
  std::uint64_t seed = 1;  ///< Seed of the displacements.
  /// Maximum from each start. A sum of absolute errors approaches its minimum by a nearly constant factor per
  /// step, as slowly as 0.97 for ideal filters.
  int max_iterations = 2000;
};

/// True for a matrix, and if there are at least four patches for each term of a root polynomial.
[[nodiscard]] bool are_enough_patches(CorrectionModel model, std::size_t patches);

/// Throws Error{usage} unless `are_enough_patches`: the terms would follow the patches instead of the camera.
void require_enough_patches(CorrectionModel model, std::size_t patches);

/// White-preserving correction that minimises the objective over the patches. The last term's column follows
/// from the white. Patches count by their weights.
///
/// If the objective is a mean colour difference, the loss of a patch is 2 a^2 (sqrt(1 + dE^2/a^2) - 1) with a
/// = 0.05, an absolute error that is smooth at zero. The least-squares start is the answer for
/// `Objective::xyz`. Throws Error{input} if the patches do not determine the correction, or if no start
/// converges to a relative change of the cost below 1e-10.
[[nodiscard]] CorrectionFit fit_correction(const PatchColors& colors, const CorrectionOptions& options = {});

/// Weights of noisy patches in the fit of a correction: t^2/(t^2 + s^2).
/// - s is the standard deviation in CIEDE2000 due to the noise of the patch's values.
/// - t is the mean colour difference under the white-preserving least-squares matrix with these weights: the
///   error that the camera makes without noise too.
///
/// Patches with s well below t have nearly equal weights. A far noisier patch has the inverse of its variance
/// as weight, which is best for independent errors of both kinds [DerSimonian1986, eq. 2]. Weights are in (0,
/// 1], and 1 if t is 0. `deviations` are those of the balanced values, one per patch. Throws Error{input} if
/// the patches do not determine the matrix.
[[nodiscard]] std::vector<double> noise_weights(const PatchColors& colors, std::span<const Raw> deviations);

}  // namespace abbe
