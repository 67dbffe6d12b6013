#pragma once

#include <optional>
#include <string>
#include <vector>

#include "spectral/colorimetry.h"
#include "spectral/interpolation.h"

namespace abbe {

/// The wavelengths of ASTM E308's sums, both ends included.
inline constexpr SumRange kAstmRange{360, 780};

/// What the X, Y and Z of each wavelength of a measurement count in the sum.
struct TristimulusWeights {
  int low_nm;
  int step_nm;
  std::vector<XYZ> weights;
};

/// Tristimulus weights for reflectances measured every `step_nm`, free of the instrument's bandpass: 1 nm
/// `tristimulus_weights`, in which the reflectance between the measured wavelengths is Lagrange's
/// polynomial through the four around, in the first and last interval through the nearest three [ASTM2022].
/// The weights of Y add up to 100, all to the illuminant's white. What the range has beyond its last whole
/// step counts for that one. The range must hold three steps or more.
[[nodiscard]] TristimulusWeights astm_weights(const Curve& illuminant, Observer observer, int step_nm,
                                              SumRange range = kAstmRange);

/// The sum of the weights.
[[nodiscard]] XYZ astm_white(const TristimulusWeights& weights);

/// Tristimulus values of a measured reflectance. Weights of wavelengths before the first or after the last
/// that was measured count for that one [ASTM308]. The samples are what `load_astm_samples`
/// accepts, at the weights' step.
[[nodiscard]] XYZ astm_tristimulus(const TristimulusWeights& weights, const Samples& samples);

/// Reads the samples of a reflectance for `astm_tristimulus`, rounded to whole nanometres: those in [360,
/// 780] nm. Reports a table that was not measured every 10 or 20 nm, beginning at 360 nm or whole steps from
/// there, or in that range at fewer than two wavelengths, and one that is no share of 1.
[[nodiscard]] std::optional<Samples> load_astm_samples(const std::string& name, const SourcePosition& where,
                                                       Diagnostics& diagnostics);

}  // namespace abbe
