#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "calibration/chart/exposure_series.h"

namespace abbe {

/// Range of codes that a recovered curve does not follow. The deviations are medians over the codes of a
/// group of nine neighbours that are off the curve, for the worst group.
struct ResponseMisfit {
  double low_code, high_code;  ///< Range in [0, 1].
  double exposure;             ///< Deviation of the exposure, as a fraction of full scale.
  double log_exposure;         ///< Deviation of ln exposure.
};

/// Recovered response of one channel.
struct ResponseFit {
  /// Linear exposure of code i/4095 as a fraction of full scale, strictly rising from 0 to 1.
  std::vector<double> linear;
  /// Standard deviation of ln exposure at each code, relative to mid-scale, where it is 0. The common factor
  /// of all exposures cannot be observed, and that of full scale hardly. The truth lies within `linear`
  /// exp(+-1.96 `log_deviation`) with about 95 % probability, averaged over the curve [Nychka1988].
  std::vector<double> log_deviation;
  double initial_cost = 0;  ///< Cost of the last pass at its start.
  double final_cost = 0;    ///< Cost of the last pass at its end.
  double median_code = 0;   ///< Median absolute residual of the code values (full scale 1).
  /// Size of the residuals in units of the stated deviations, or of those estimated from earlier residuals.
  double noise_scale = 0;
  double roughness = 0;     ///< Weight of the curve's second differences, chosen by cross-validation.
  std::size_t samples = 0;  ///< Number of code values in use, which are neither black nor clipped.
  int iterations = 0;       ///< Iterations of all passes.
  /// Misfit that neither noise nor outliers explain, such as a knee sharper than the curve can follow. At
  /// least three of nine neighbouring codes are off, significantly more than elsewhere. `log_deviation`
  /// includes it. Empty if the curve follows all codes to 0.2 % of full scale, and for a series that does not
  /// state deviations, which are then estimated from the residuals themselves.
  std::optional<ResponseMisfit> misfit = {};
};

/// Recovers the response of one channel from a series of known exposure times. The unknowns are the curve g
/// and the exposures E_i of the patches. The fit minimises the sum over samples of Cauchy([g(z_ij) - ln E_i -
/// ln t_j]/s_ij) plus a smoothness term on g [Debevec1997, eq. 3]. Here s_ij is the standard deviation of the
/// code times the slope of the curve.
///
/// - The first pass has a wide loss and assumes a straight line in the curve's coordinate for the slope.
/// - Two more passes take slope and residuals from the pass before. They exclude codes so near to black or
///   full scale that noise may have clipped them. Leaving out one exposure at a time chooses the weight of
///   the smoothness, exactly for the linearised problem.
/// - Deviations that the series does not state are estimated from the residuals, by code.
///
/// The result depends on ratios of times only. Calls must not run concurrently, because the fit sets the
/// global log level of glog meanwhile.
///
/// Throws Error{input} if
/// - fewer than 32 codes are usable (`usable_samples`), or the fitted curve does not rise everywhere;
/// - times and codes contradict one another (`require_usable_times`);
/// - the series does not determine the curve (`require_determined`);
/// - the solver does not converge in `max_iterations` per pass.
[[nodiscard]] ResponseFit recover_response(const ExposureSeries& series, int max_iterations = 300);

/// Lower and upper end of the 95 % interval of entry i of `ResponseFit::linear`, as fractions of full scale.
[[nodiscard]] std::pair<double, double> bounds_95(const ResponseFit& fit, std::size_t i);

/// Largest half-width of the 95 % interval of exposure between 1 % and 99 % of the code range, as a fraction
/// of full scale.
[[nodiscard]] double largest_uncertainty(const ResponseFit& fit);

/// Linear exposure of a code value, as a fraction of full scale: linear interpolation in `table`, such as
/// `ResponseFit::linear`, of at least two entries. Codes are first clipped to [0, 1].
[[nodiscard]] double linearise(const std::vector<double>& table, double code);

/// Standard deviation of the linear exposure of a code: its `deviation` times the mean slope of the table
/// within one deviation of the code, limited to [0, 1]. Returns 0 for a deviation of 0.
[[nodiscard]] double linearise_deviation(const std::vector<double>& table, double code, double deviation);

}  // namespace abbe
