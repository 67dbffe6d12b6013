#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "calibration/chart/patches.h"
#include "spectral/matrix3.h"

namespace abbe {

/// Which terms of the raw values a colour correction adds up. All have degree 1, so that a correction
/// commutes with exposure, and all are 1 at (1, 1, 1).
enum class CorrectionModel {
  linear,             ///< R, G, B: a matrix.
  root_polynomial_2,  ///< With the square roots of RG, GB, RB [Finlayson2015].
  root_polynomial_3,  ///< With the cube roots of RG^2, GB^2, RB^2, GR^2, BG^2, BR^2 and RGB too.
};

/// Their names, in that order.
inline constexpr std::array kCorrectionNames{"matrix", "root-polynomial-2", "root-polynomial-3"};

/// How many terms a model has.
[[nodiscard]] constexpr std::size_t term_count(CorrectionModel model) {
  return model == CorrectionModel::linear ? 3 : model == CorrectionModel::root_polynomial_2 ? 6 : 13;
}

/// The terms of white-balanced raw values; the root of a negative product is zero.
[[nodiscard]] std::vector<double> correction_terms(CorrectionModel model, const Raw& raw);

/// What turns white-balanced raw values into XYZ, Y = 1 for the perfect diffuser.
struct ColorCorrection {
  CorrectionModel model = CorrectionModel::linear;
  std::vector<XYZ> columns;  ///< What each term adds, in the order of `correction_terms`.

  [[nodiscard]] XYZ operator()(const Raw& raw) const;
};

/// The correction by a matrix.
[[nodiscard]] ColorCorrection linear_correction(const Matrix3& raw_to_xyz);

/// The first three columns of a correction: all of a linear one.
[[nodiscard]] Matrix3 linear_part(const ColorCorrection& correction);

}  // namespace abbe
