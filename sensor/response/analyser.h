#pragma once

#include <optional>

#include "spectral/curve.h"
#include "spectral/stokes.h"

namespace abbe {

/// What a channel measures of polarised light over what it measures of unpolarised light: of a Stokes vector
/// (I, Q, U, V) in the frame of the film it weighs i I + c (q Q + u U + v V), c being its contrast. A channel
/// without one measures I.
struct Analyser {
  float i = 1;
  float q = 0;
  float u = 0;
  float v = 0;
  Curve contrast = Curve(1.0);  ///< In [0, 1].
};

/// The weights of an analyser at the lanes of a packet.
[[nodiscard]] StokesSpectrum row_of(const Analyser& analyser, const SampledSpectrum& wavelengths_nm);

/// A polariser for linearly polarised light, which lies before a film.
struct Polariser {
  double angle_deg = 0;  ///< Of the axis along which it lets light pass, from the picture's right towards up.
  Curve transmittance = Curve(1.0);  ///< Of light polarised along that axis.
  /// That transmittance over that of light polarised across the axis, 1 or more; infinite when absent.
  std::optional<Curve> extinction_ratio = {};
};

/// The share of unpolarised light that passes: half of the sum of both transmittances.
[[nodiscard]] Curve mean_transmittance(const Polariser& polariser);
/// What it measures over that share: the first row of its Mueller matrix, whose contrast is (r - 1)/(r + 1)
/// for an extinction ratio r.
[[nodiscard]] Analyser analyser_of(const Polariser& polariser);

}  // namespace abbe
