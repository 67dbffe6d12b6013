#pragma once

#include <optional>
#include <string>
#include <vector>

#include "spectral/colorimetry.h"
#include "spectral/interpolation.h"

namespace abbe {

/// Wavelengths of the sums of ASTM E308 [nm], both ends included.
inline constexpr SumRange kAstmRange{360, 780};

/// Weights of X, Y and Z at each wavelength of a measurement.
struct TristimulusWeights {
  int low_nm;
  int step_nm;
  std::vector<XYZ> weights;
};

/// Tristimulus weights for reflectances measured every `step_nm` without the bandpass of an instrument
/// [ASTM2022]. They combine the 1 nm `tristimulus_weights` with Lagrange interpolation of the reflectance.
/// The polynomial passes through the four samples around a wavelength, or through the nearest three in the
/// first and last interval. The weights of Y add up to 100, and all weights to the white of the illuminant.
/// Wavelengths after the last whole step count for that step. The range must contain at least three steps.
[[nodiscard]] TristimulusWeights astm_weights(const Curve& illuminant, Observer observer, int step_nm,
                                              SumRange range = kAstmRange);

/// Sum of the weights: the tristimulus values of the perfect diffuser.
[[nodiscard]] XYZ astm_white(const TristimulusWeights& weights);

/// Tristimulus values of a measured reflectance. Weights of wavelengths outside the measurement count for its
/// first or last sample [ASTM308]. The samples must be those of `load_astm_samples`, at the step of the
/// weights.
[[nodiscard]] XYZ astm_tristimulus(const TristimulusWeights& weights, const Samples& samples);

/// Reads the samples of a reflectance within [360, 780] nm for `astm_tristimulus`, with wavelengths rounded
/// to whole nanometres. Reports a table
/// - whose step is neither 10 nor 20 nm;
/// - that does not begin a whole number of steps from 360 nm;
/// - with fewer than two samples in the range;
/// - whose unit is not a fraction of 1.
[[nodiscard]] std::optional<Samples> load_astm_samples(const std::string& name, const SourcePosition& where,
                                                       Diagnostics& diagnostics);

}  // namespace abbe
