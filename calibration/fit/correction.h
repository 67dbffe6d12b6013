#pragma once

#include <array>
#include <cmath>
#include <cstddef>
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

/// Number of terms of a model.
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

/// Correction by a matrix.
[[nodiscard]] ColorCorrection linear_correction(const Matrix3& raw_to_xyz);

/// Matrix of the first three columns of a correction, which are all columns of a linear one.
[[nodiscard]] Matrix3 linear_part(const ColorCorrection& correction);

}  // namespace abbe
