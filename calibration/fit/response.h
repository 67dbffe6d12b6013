#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calibration/chart/exposure_series.h"

namespace abbe {

/// A range of codes that a recovered curve does not follow, with the median deviation of their exposures.
struct ResponseMisfit {
  double low_code, high_code;  ///< Range in [0, 1].
  double exposure;             ///< Fraction of full scale.
  double log_exposure;         ///< Difference of ln exposure.
};

/// One channel's recovered response.
struct ResponseFit {
  std::vector<double>
      linear;  ///< Linear exposure of code i/(size - 1), rising strictly from 0 to 1 at full scale.
  /// Standard deviation of ln of exposure at each code, relative to that at mid-scale, where it is 0: the
  /// factor of all exposures is not observable, and that of full scale hardly. The truth lies within
  /// `linear` exp(+-1.96 of it) with about 95 % probability, taken over the curve [Nychka1988].
  std::vector<double> log_deviation;
  double initial_cost = 0;  ///< Of the last pass, at its start.
  double final_cost = 0;    ///< Of the last pass.
  double median_code =
      0;  ///< Median size of the residuals, about that of the errors of the code values (full scale 1).
  /// Size of the residuals in units of the deviations that were stated, or else of those learnt of residuals
  /// before.
  double noise_scale = 0;
  double roughness = 0;     ///< Weight of the curve's second differences that cross-validation chose.
  std::size_t samples = 0;  ///< Code values used: neither black nor clipped.
  int iterations = 0;       ///< Of all passes.
  /// Misfit that neither noise nor outliers explain, such as a knee that is sharper than the curve can be: of
  /// nine neighbouring codes at least three are off, and significantly more than elsewhere. `log_deviation`
  /// includes it in its range. Empty if the curve follows all codes to 0.2 % of full scale. Also empty if the
  /// series does not state deviations: they are then estimated from the residuals themselves.
  std::optional<ResponseMisfit> misfit = {};
};

/// How a response is recovered.
struct ResponseOptions {
  std::size_t table_size = 4096;
  int max_iterations = 300;  ///< Of each pass.
};

/// Recovers the response of one channel from a series of known exposure times: minimises over the curve g and
/// the patches' unknown exposures E_i the sum over samples of Cauchy([g(z_ij) - ln E_i - ln t_j]/s_ij) plus a
/// smoothness term on g [Debevec1997, eq. 3], s_ij being the deviation of the code times the curve's slope. A
/// first pass has a wide loss and the slope of a straight line in the curve's coordinate; two more take slope
/// and size of the residuals from the one before, leave out codes so near to black or full scale that noise
/// may have clipped them, and choose the weight of smoothness by leaving out each exposure in turn, exactly
/// for the linearised problem. Deviations that the series does not state are learnt of the residuals before,
/// by code. Throws Error{input} when times and codes contradict one another (`require_usable_times`), when
/// the series does not determine the curve (`require_determined`), and when the solver does not converge.
[[nodiscard]] ResponseFit recover_response(const ExposureSeries& series, const ResponseOptions& options = {});

/// The 95 % interval of the exposure of entry i of the curve.
[[nodiscard]] std::pair<double, double> bounds_95(const ResponseFit& fit, std::size_t i);

/// Half the width of the 95 % interval of the exposure of a code in [0, 1], as a share of full scale.
[[nodiscard]] double half_width_95(const ResponseFit& fit, double code);

/// The largest half-width of the 95 % interval of exposure between 1 % and 99 % of the code range, as a share
/// of full scale.
[[nodiscard]] double largest_uncertainty(const ResponseFit& fit);

/// Linear exposure of a code value in [0, 1] by linear interpolation in such a table.
[[nodiscard]] double linearise(const std::vector<double>& table, double code);

/// Standard deviation of the linear exposure of a code of this standard deviation: that times the mean slope
/// of such a table within a deviation of the code.
[[nodiscard]] double linearise_deviation(const std::vector<double>& table, double code, double deviation);

}  // namespace abbe
