#pragma once

#include <optional>

#include "spectral/curve.h"
#include "spectral/stokes.h"

namespace abbe {

/// Response of a channel to polarised light relative to unpolarised light. A Stokes vector (I, Q, U, V) in
/// the frame of the film counts i I + c (q Q + u U + v V), where c is the contrast. A channel without an
/// analyser measures I.
struct Analyser {
  float i = 1;  ///< 0 for a channel of one signed component (`with_stokes`).
  float q = 0;
  float u = 0;
  float v = 0;
  Curve contrast = Curve(1.0);  ///< Polarisation contrast in [0, 1].
};

/// Weights (i, c q, c u, c v) of an analyser at several wavelengths [nm].
[[nodiscard]] StokesSpectrum row_of(const Analyser& analyser, const SampledSpectrum& wavelengths_nm);

/// A linear polariser in front of a film.
struct Polariser {
  double angle_deg = 0;  ///< Transmission axis in degrees, counterclockwise from the right of the picture.
  Curve transmittance = Curve(1.0);  ///< Transmittance of light polarised along the axis, in [0, 1].
  /// Ratio of that transmittance to the one across the axis, at least 1; infinite if absent.
  std::optional<Curve> extinction_ratio = {};
};

/// Transmitted fraction of unpolarised light: half of the sum of both transmittances.
[[nodiscard]] Curve mean_transmittance(const Polariser& polariser);
/// Analyser of a polariser, relative to its mean transmittance: the first row of its Mueller matrix. The
/// contrast is (r - 1)/(r + 1) for an extinction ratio r.
[[nodiscard]] Analyser analyser_of(const Polariser& polariser);

}  // namespace abbe
