#pragma once

#include <optional>
#include <span>

namespace abbe {

/// A lit pair of flat exposures, less darkness.
struct LinearityPoint {
  double exposure_s;
  double signal_dn;
  double variance_dn2;
  double variance_error2;  ///< Squared standard error of the variance [DN^4].
};

/// The linearity error LE of [EMVA1288] in percent: the mean of |y - (a_0 + a_1 t)|/(a_0 + a_1 t) over the
/// signals y between 5 and 95 % of saturation. The line over the exposure times t has the least relative
/// squares. Nothing for fewer than four times, and where LE is above 10 %, as of a light that was not the
/// same.
[[nodiscard]] std::optional<double> linearity_error_percent(std::span<const LinearityPoint> points,
                                                            double saturation_dn);

/// A relative error and its standard error.
struct RelativeBias {
  double value;
  double standard_error;
};

/// The relative error of the photon-transfer gain K = sum(y^2)/sum(y v) against that of weak light, since
/// signals y are no straight line of the light. A response y = f(l) makes the variance f'(l)^2 l/K of that of
/// photons. Where `is_light_constant`, f is a parabola without offset over the exposure times, which the
/// means determine best. Otherwise the variances themselves show it: v/y = (1 + b y)/K. Nothing for fewer
/// than three different signals.
[[nodiscard]] std::optional<RelativeBias> gain_bias(std::span<const LinearityPoint> points,
                                                    bool is_light_constant);

}  // namespace abbe
