#pragma once

#include <optional>
#include <span>

namespace abbe {

/// An illuminated pair of flat exposures. Mean and variance are those above darkness of the same exposure
/// time.
struct LinearityPoint {
  double exposure_s;
  double signal_dn;        ///< Mean above darkness.
  double variance_dn2;     ///< Temporal variance above that of darkness.
  double variance_error2;  ///< Squared standard error of the variance [DN^4].
};

/// Linearity error LE of [EMVA1288] in percent: mean of |y - (a_0 + a_1 t)|/(a_0 + a_1 t) over the signals y
/// between 5 and 95 % of saturation. The line over the exposure times t minimises relative squares.
/// `saturation_dn` is the saturation signal above darkness. Nothing for fewer than four times, and for LE
/// above 10 %, which indicates that the light was not constant.
[[nodiscard]] std::optional<double> linearity_error_percent(std::span<const LinearityPoint> points,
                                                            double saturation_dn);

/// A relative error, as a fraction, and its standard error.
struct RelativeBias {
  double value;
  double standard_error;
};

/// Relative error of the photon-transfer gain K = sum(y^2)/sum(y v) at weak light, if the signal y is not
/// linear in the light; v is its variance. The value is the measured K over the true one, minus 1. A response
/// y = f(l) changes the variance of photon noise to f'(l)^2 l/K. If `is_light_constant`, f is a parabola
/// without offset over the exposure times, which the means determine best. Otherwise the variances determine
/// it: v/y = (1 + b y)/K. Nothing for fewer than three different signals, for a fit that does not determine
/// the slope at weak light, and for variances without errors.
[[nodiscard]] std::optional<RelativeBias> gain_bias(std::span<const LinearityPoint> points,
                                                    bool is_light_constant);

}  // namespace abbe
