#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sensor/readout/code_levels.h"
#include "sensor/readout/linearity.h"

namespace abbe {

/// Two exposures of one evenly lit (or dark) sensor, taken one after the other: all they differ in is
/// temporal noise. Their codes, of equally many pixels.
struct FlatPair {
  double exposure_s;
  std::span<const std::uint16_t> first;
  std::span<const std::uint16_t> second;
};

/// A lit pair of the photon-transfer curve.
struct TransferPoint {
  double signal_dn;     ///< Mean above that of darkness.
  double variance_dn2;  ///< From one exposure to the next, above that of darkness.
};

/// What measurements say of a sensor with a linear response, in the terms of `Readout`.
struct PhotonTransfer {
  double gain_e_per_dn;
  double read_noise_e;
  double dark_e_per_s;
  double prnu_percent;
  double dsnu_e;
  std::optional<double> full_well_e;                     ///< `saturation_e`, if the codes do not end first.
  std::vector<TransferPoint> points = {};                ///< The lit pairs in their order.
  double gain_standard_error = 0;                        ///< [e/DN]
  std::optional<double> read_noise_standard_error = {};  ///< [e]; nothing where rounding hides the noise.
  /// Electrons at which wells are full or codes end; nothing where the brightest lit pair reaches neither.
  std::optional<double> saturation_e = {};
  std::optional<double> linearity_error_percent = {};  ///< By that function, of the lit pairs.
  std::optional<RelativeBias> gain_bias = {};  ///< By that function, of the pairs that K is fitted to.
};

/// The photon transfer method of [EMVA1288]: temporal variance, from the difference of two exposures, less
/// that of rounding, grows with the mean by 1/K DN per DN, the read noise being what darkness leaves; fixed
/// patterns are how the first frames of pairs vary over the pixels together with the second ones. `dark`
/// holds pairs of two or more exposure times, `lit` pairs from weak light to light beyond saturation: K is
/// fitted up to 70 % of saturation, which is taken from the brightest pair, as is the full well. PRNU is the
/// pattern of the lit pair nearest to 50 % of saturation less, pixel by pixel, darkness of its exposure time:
/// of the dark pairs of that time where there are some, else from the line through each pixel's dark signals
/// over the exposure time or, where a line from afar would add too much noise, from the pair nearest in time.
/// Pixels whose darkness leaves no room for the light of that pair do not count in it. DSNU is the pattern of
/// darkness at 0 s, likewise. Both are 0 where noise hides them. Pixels that are full in a dark pair, as hot
/// ones are in long exposures, do not count in anything. Standard errors are of the pairs' temporal
/// variances, each known by its pixels' fourth moment and, of noise that is narrower than a code, as far as
/// rounding is; they are carried through the fits. Pixels count as independent, which those of a row with
/// noise of its own are not. `bits`: of the codes; `levels`: what each of them stands for; `white_dn`: the
/// code from which a pixel is full where no lit pair tells that, the highest one if it is beyond. Throws
/// Error{input} for pairs that do not determine this.
[[nodiscard]] PhotonTransfer photon_transfer(std::span<const FlatPair> dark, std::span<const FlatPair> lit,
                                             int bits, const std::vector<CodeLevel>& levels = code_levels({}),
                                             std::uint16_t white_dn = 65535);

}  // namespace abbe
