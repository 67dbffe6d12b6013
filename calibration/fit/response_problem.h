#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include <ceres/ceres.h>

#include "calibration/fit/response_model.h"
#include "calibration/fit/response_samples.h"

namespace abbe {

/// Unknowns of a response fit. All 0 is a straight line in the coordinate of `ResponseModel`.
struct ResponseUnknowns {
  /// Logarithms of the coefficients of the curve.
  std::array<double, ResponseModel<double>::kCoefficients> theta{};
  /// One per patch: ln of its exposure in one second, relative to that of kMidCode.
  std::vector<double> log_exposure;

  /// Curve of these coefficients, to which it refers.
  [[nodiscard]] ResponseModel<double> model() const { return ResponseModel<double>(theta.data()); }
};

/// Samples with weights that scale their residuals to a standard deviation of 1.
struct WeightedSamples {
  std::vector<ResponseSample> samples;
  std::vector<double> weights;  ///< One per sample: the inverse standard deviation of its ln exposure.
  double loss = 0;              ///< Width of the Cauchy loss, in units of that deviation.
};

/// Residuals of the smoothness term: second differences of the coefficients times `roughness`, and first
/// differences. The latter have a small weight, which only continues the slope where there are no samples.
struct ResponseSmoothness {
  static constexpr std::size_t kCoefficients = ResponseModel<double>::kCoefficients;
  static constexpr int kTerms = static_cast<int>(2 * kCoefficients - 3);  ///< Number of residuals.
  static constexpr double kSlopeDrift = 0.01;  ///< Weight of the first differences.

  double roughness;

  template <typename T>
  bool operator()(const T* theta, T* residual) const {
    for (std::size_t k = 0; k + 2 < kCoefficients; ++k)
      residual[k] = roughness * (theta[k] - 2.0 * theta[k + 1] + theta[k + 2]);
    for (std::size_t k = 0; k + 1 < kCoefficients; ++k)
      residual[kCoefficients - 2 + k] = kSlopeDrift * (theta[k + 1] - theta[k]);
    return true;
  }
};
using SmoothnessCost = ceres::AutoDiffCostFunction<ResponseSmoothness, ResponseSmoothness::kTerms,
                                                   static_cast<int>(ResponseSmoothness::kCoefficients)>;

/// Least-squares problem of the samples' residuals. It refers to `unknowns`, which must outlive it; a solver
/// writes its solution there.
[[nodiscard]] std::unique_ptr<ceres::Problem> data_terms(const WeightedSamples& data,
                                                         ResponseUnknowns& unknowns);

/// `data_terms` with the smoothness term of weight `roughness`.
[[nodiscard]] std::unique_ptr<ceres::Problem> all_terms(const WeightedSamples& data, double roughness,
                                                        ResponseUnknowns& unknowns);

}  // namespace abbe
