#pragma once

#include <optional>
#include <string>
#include <vector>

#include "spectral/colorimetry.h"
#include "spectral/interpolation.h"

namespace abbe {

/// Wavelengths of the sums of ASTM E308 [nm], both ends included.
inline constexpr SumRange kAstmRange{360, 780};

/// Weights of X, Y and Z for a reflectance measured at evenly spaced wavelengths.
struct TristimulusWeights {
  int low_nm;  ///< Wavelength of the first weight.
  int step_nm;
  std::vector<XYZ> weights;  ///< `weights[i]` belongs to the wavelength `low_nm` + i `step_nm`.
};

/// Tristimulus weights for reflectances measured every `step_nm` without the bandpass of an instrument
/// [ASTM2022]. They combine the 1 nm `tristimulus_weights` with Lagrange interpolation of the reflectance.
/// The polynomial passes through the four samples around a wavelength, or through the nearest three in the
/// first and last interval. The weights of Y add up to 100, those of X and Z to the X and Z of the illuminant
/// on this scale. If `range` does not end at a sample, wavelengths after the last sample have its
/// reflectance. The caller ensures that the range contains at least three samples. Throws Error{input} if the
/// shipped table of the observer is missing.
[[nodiscard]] TristimulusWeights astm_weights(const Curve& illuminant, Observer observer, int step_nm,
                                              SumRange range = kAstmRange);

/// Sum of the weights: the tristimulus values of the perfect diffuser.
[[nodiscard]] XYZ astm_white(const TristimulusWeights& weights);

/// Tristimulus values of a measured reflectance, with Y = 100 for the perfect diffuser. Weights of
/// wavelengths outside the measurement count for its first or last sample [ASTM308]. The caller ensures that
/// the samples lie on the wavelength grid of the weights, as those of `load_astm_samples` do for the same
/// step.
[[nodiscard]] XYZ astm_tristimulus(const TristimulusWeights& weights, const Samples& samples);

/// Reads the samples of a reflectance for `astm_tristimulus` by the name of a table in `data/reflectance`.
/// Returns those within [360, 780] nm, at least two, with wavelengths rounded to whole nanometres. Reports an
/// error, and returns nothing, unless the step is 10 or 20 nm and the first wavelength is a whole number of
/// steps from 360 nm. The errors of `load_samples` and of `kReflectanceUse` are reported, too.
[[nodiscard]] std::optional<Samples> load_astm_samples(const std::string& name, const SourcePosition& where,
                                                       Diagnostics& diagnostics);

}  // namespace abbe
