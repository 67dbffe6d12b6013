#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "calibration/chart/exposure_series.h"

namespace abbe {

/// One channel's recovered response.
struct ResponseFit {
  std::vector<double>
      linear;  ///< Linear exposure of code i/(size - 1), rising strictly from 0 to 1 at full scale.
  double initial_cost = 0;  ///< Of the second pass, at its start.
  double final_cost = 0;    ///< Of the second pass.
  double median_code =
      0;  ///< Median size of the residuals, about that of the errors of the code values (full scale 1).
  std::size_t samples = 0;  ///< Code values used: neither black nor clipped.
  int iterations = 0;       ///< Of both passes.
};

/// Recovers the response of one channel from a series of known exposure times: minimises over the curve g and
/// the patches' unknown exposures E_i the sum over samples of Cauchy(w(z_ij) [g(z_ij) - ln E_i - ln t_j])
/// plus a smoothness term on g [Debevec1997, eq. 3]. w is the slope of the code against the curve's
/// coordinate, so residuals are errors of the code value. A first pass has a loss 1 % of full scale wide; a
/// second one is as narrow as the residuals of the first, so that outliers lose their hold. Throws
/// Error{input} when the series does not determine the curve or the solver does not converge.
[[nodiscard]] ResponseFit recover_response(const ExposureSeries& series, std::size_t table_size = 4096);

/// Linear exposure of a code value in [0, 1] by linear interpolation in such a table.
[[nodiscard]] double linearise(const std::vector<double>& table, double code);

}  // namespace abbe
