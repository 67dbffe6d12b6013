#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include <ceres/ceres.h>

#include "calibration/chart/exposure_series.h"

namespace abbe {

/// One usable code of an exposure series.
struct ResponseSample {
  std::size_t patch;  ///< Index of the patch in the series.
  double code;        ///< Code value in (0, 1).
  double deviation;   ///< Standard deviation of the code; 1 while unknown.
  double log_time;    ///< ln of the exposure time in seconds.
};

/// True if a code is so far from black and from full scale that noise of this standard deviation cannot have
/// clipped it: more than 8 deviations above 0 and 4 below 1.
[[nodiscard]] bool within_margins(double code, double deviation);

/// Usable codes of a series, patch by patch. Excluded are black and clipped codes. Codes of longer times than
/// one that clipped, and of shorter times than one that was black, are excluded too: only noise moves these
/// off the ends. `with_margins` also excludes codes that are not `within_margins` for known deviations.
[[nodiscard]] std::vector<ResponseSample> usable_samples(const ExposureSeries& series, bool with_margins);

/// A monotone sensor response: ln(linear exposure) as a function of the code value z in (0, 1]. It is a
/// template on its scalar, so that the solver differentiates the same function.
///
/// The coordinate is u(z) = ln z - ln(1 + kShoulder - z), in which a power-law toe and a logistic shoulder
/// are both straight lines. ln exposure is a sum of cumulative uniform B-splines in u (I-splines
/// [Ramsay1988]) with coefficients exp(theta) > 0. It therefore rises strictly. It is zero at kMidCode,
/// because the scale of the exposure cannot be observed.
template <typename T>
class ResponseModel {
 public:
  static constexpr std::size_t kCoefficients = 32;  ///< Number of B-splines.
  static constexpr double kMidCode = 0.5;           ///< Code of mid-scale.

  /// `theta` points to the kCoefficients logarithms of the coefficients, which must outlive the model.
  explicit ResponseModel(const T* theta) : theta_(theta) {}

  /// ln of the linear exposure relative to that of kMidCode. Codes are limited to [1/65536, 1].
  [[nodiscard]] T operator()(double code) const {
    using std::exp;
    const double x = position(code);
    const double x_mid = position(kMidCode);
    T sum(0.0);
    for (std::size_t k = 0; k < kCoefficients; ++k)
      sum += exp(theta_[k]) * (cumulative(x - knot(k)) - cumulative(x_mid - knot(k)));
    return sum;
  }

  /// Derivative of ln exposure by the code in (0, 1].
  [[nodiscard]] T slope(double code) const {
    using std::exp;
    const double x = position(code);
    T sum(0.0);
    for (std::size_t k = 0; k < kCoefficients; ++k) sum += exp(theta_[k]) * bump(x - knot(k));
    return sum / (sensitivity(code) * spacing());
  }

  /// d code / d u: sensitivity of the code to u, largest at mid-scale and falling towards toe and shoulder.
  [[nodiscard]] static double sensitivity(double code) {
    return code * (1 + kShoulder - code) / (1 + kShoulder);
  }

 private:
  static constexpr double kShoulder = 0.2;
  static constexpr double kLowestCode = 1.0 / 65536;

  static double coordinate(double code) { return std::log(code) - std::log(1 + kShoulder - code); }

  // u in units of the knot spacing, from the lowest code.
  static double position(double code) {
    static const double low = coordinate(kLowestCode);
    return (coordinate(std::clamp(code, kLowestCode, 1.0)) - low) / spacing();
  }
  static double spacing() {
    static const double knot_spacing =
        (coordinate(1) - coordinate(kLowestCode)) / static_cast<double>(kCoefficients - 2);
    return knot_spacing;
  }
  static double knot(std::size_t k) { return static_cast<double>(k) - 2; }

  // Integral of the quadratic uniform B-spline on [0, 3]: rises from 0 to 1.
  static double cumulative(double x) {
    if (x <= 0) return 0;
    if (x >= 3) return 1;
    if (x < 1) return x * x * x / 6;
    if (x > 2) return 1 - (3 - x) * (3 - x) * (3 - x) / 6;
    return 0.5 + (x - 1.5) * (0.75 - (x - 1.5) * (x - 1.5) / 3);
  }

  // Derivative of `cumulative`: the quadratic uniform B-spline.
  static double bump(double x) {
    if (x <= 0 || x >= 3) return 0;
    if (x < 1) return x * x / 2;
    if (x > 2) return (3 - x) * (3 - x) / 2;
    return 0.75 - (x - 1.5) * (x - 1.5);
  }

  const T* theta_;
};

/// Unknowns of a response fit. All 0 is a straight line in the coordinate of `ResponseModel`.
struct ResponseUnknowns {
  std::array<double, ResponseModel<double>::kCoefficients> theta{};
  /// One per patch: ln of its exposure in one second, relative to that of kMidCode.
  std::vector<double> log_exposure;

  [[nodiscard]] ResponseModel<double> model() const { return ResponseModel<double>(theta.data()); }
};

/// Samples with weights that scale their residuals to a standard deviation of 1.
struct WeightedSamples {
  std::vector<ResponseSample> samples;
  std::vector<double> weights;  ///< One per sample: the inverse standard deviation of its ln exposure.
  double loss = 0;              ///< Width of the Cauchy loss, in units of that deviation.
};

/// Least-squares problem of the samples' residuals and of the smoothness term: second differences of the
/// coefficients times `roughness`, and first differences. It refers to `unknowns`, which must outlive it; a
/// solver writes its solution there.
[[nodiscard]] std::unique_ptr<ceres::Problem> all_terms(const WeightedSamples& data, double roughness,
                                                        ResponseUnknowns& unknowns);

/// Weight of the smoothness, a power of two from 1 to 4096, that best predicts exposures left out one at a
/// time. The problem is linearised at the unknowns, which remain unchanged. Whole exposures are left out,
/// because the samples of one have the error of its time in common, and similar patches have the same
/// rounding.
[[nodiscard]] double choose_roughness(const WeightedSamples& data, ResponseUnknowns& unknowns);

}  // namespace abbe
