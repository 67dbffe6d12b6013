#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sensor/readout/readout.h"

namespace abbe {

/// A point of the photon-transfer curve: an illuminated pair of flat exposures.
struct TransferPoint {
  double exposure_s;
  double signal_dn;        ///< Mean above darkness of the same exposure time.
  double variance_dn2;     ///< Temporal variance above that of darkness.
  double variance_error2;  ///< Squared standard error of the variance [DN^4].
};

/// Linearity error LE of [EMVA1288] in percent: mean of |y - (a_0 + a_1 t)|/(a_0 + a_1 t) over the signals y
/// between 5 and 95 % of saturation. The line over the exposure times t minimises relative squares.
/// `saturation_dn` is the saturation signal above darkness. Nothing for fewer than four times, and for LE
/// above 10 %, which indicates that the light was not constant.
[[nodiscard]] std::optional<double> linearity_error_percent(std::span<const TransferPoint> points,
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
[[nodiscard]] std::optional<RelativeBias> gain_bias(std::span<const TransferPoint> points,
                                                    bool is_light_constant);

/// Codes of two exposures of a uniformly illuminated or dark sensor, taken one after the other. They differ
/// only by temporal noise and have equally many pixels.
struct FlatPair {
  double exposure_s;
  std::span<const std::uint16_t> first;
  std::span<const std::uint16_t> second;
};

/// Measured parameters of a sensor with a linear response, in the terms of `Readout`.
struct PhotonTransfer {
  double gain_e_per_dn;  ///< K of EMVA 1288.
  double read_noise_e;
  double dark_e_per_s;
  double prnu_percent;  ///< Relative to the mean signal.
  double dsnu_e;
  std::optional<double> full_well_e;  ///< `saturation_e` if wells are full there; nothing if codes end first.
  std::vector<TransferPoint> points = {};                ///< Illuminated pairs in their order.
  double gain_standard_error = 0;                        ///< [e/DN]
  std::optional<double> read_noise_standard_error = {};  ///< [e]; nothing if rounding hides the noise.
  /// Electrons at which wells are full or codes end; nothing if the brightest illuminated pair reaches
  /// neither.
  std::optional<double> saturation_e = {};
  std::optional<double> linearity_error_percent = {};  ///< Of the illuminated pairs.
  std::optional<RelativeBias> gain_bias = {};          ///< Of the pairs that K is fitted to.
};

/// Photon-transfer method of [EMVA1288].
/// - Temporal variance comes from the difference of two exposures, minus rounding. It grows with the mean by
///   1/K DN per DN, and its value in darkness is the read noise.
/// - Fixed patterns come from the covariance over the pixels of the first and the second frames of pairs.
/// - The saturation signal is that of the illuminated pair with the largest variance. K is fitted to pairs up
///   to 70 % of it.
/// - `saturation_e` and the full well come from the brightest pair, if its variance is below half that of its
///   photon noise.
/// - PRNU is the pattern of the illuminated pair nearest to 50 % of the saturation signal, minus the darkness
///   of each pixel at its exposure time. The darkness is measured at that time or taken from the line through
///   the dark signals over time. If the line adds too much noise, the dark pair nearest in time replaces it.
///   Pixels count only if their darkness leaves room for the light of the pair.
/// - DSNU is the pattern of darkness at 0 s, obtained in the same way. PRNU and DSNU are 0 if noise hides
///   them.
/// - Pixels that are full in a dark pair, such as hot pixels in long exposures, are excluded throughout.
/// - Standard errors propagate those of the temporal variances through the fits. The latter follow from the
///   fourth moments, and for noise narrower than a code from the uncertainty of rounding. Pixels count as
///   independent, which row noise violates.
///
/// `dark` has pairs of at least two exposure times, `illuminated` pairs from weak light to above saturation.
/// `bits` is the depth of the codes; `levels[c]` is the level of the 16-bit code c, for all 65536 codes.
/// `white_dn` is the code of a full pixel if no illuminated pair shows it, limited to the highest code.
/// Throws Error{input} without dark or illuminated pairs, for frames of unequal sizes or fewer than two
/// pixels, and for pairs that do not determine the result.
[[nodiscard]] PhotonTransfer photon_transfer(std::span<const FlatPair> dark,
                                             std::span<const FlatPair> illuminated, int bits,
                                             const std::vector<CodeLevel>& levels = code_levels({}),
                                             std::uint16_t white_dn = 65535);

}  // namespace abbe
