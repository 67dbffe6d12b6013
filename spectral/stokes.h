#pragma once

#include <array>

#include "spectral/sampled_spectrum.h"

namespace abbe {

/// Stokes vector (I, Q, U, V) at one wavelength or in one channel; `StokesSpectrum` states the signs.
using StokesVector = std::array<double, 4>;

/// Stokes vector (I, Q, U, V) of each wavelength, or the row of weights of an analyser. Its reference frame
/// is x and y = k cross x, where k is the unit vector along which the light travels. Q = |E_x|^2 - |E_y|^2; U
/// > 0 oscillates between +x and +y. V > 0 turns clockwise for a receiver who looks against k
/// (`docs/reference/physics.md`).
struct StokesSpectrum {
  SampledSpectrum i{};
  SampledSpectrum q{};
  SampledSpectrum u{};
  SampledSpectrum v{};

  StokesSpectrum& operator+=(const StokesSpectrum& b) {
    i += b.i;
    q += b.q;
    u += b.u;
    v += b.v;
    return *this;
  }
  StokesSpectrum& operator*=(const SampledSpectrum& s) {
    i *= s;
    q *= s;
    u *= s;
    v *= s;
    return *this;
  }
  friend StokesSpectrum operator*(StokesSpectrum a, const SampledSpectrum& s) { return a *= s; }
};

/// Product of an analyser's row and a Stokes vector in the same frame, for each wavelength.
[[nodiscard]] inline SampledSpectrum measured(const StokesSpectrum& row, const StokesSpectrum& vector) {
  return row.i * vector.i + row.q * vector.q + row.u * vector.u + row.v * vector.v;
}

/// Stokes vector or row in a frame turned right-handed by an angle about the direction k in which the light
/// travels [Born1999, sec. 10.9]. The arguments are cosine and sine of twice that angle.
[[nodiscard]] inline StokesSpectrum turned(const StokesSpectrum& s, float cos_twice, float sin_twice) {
  return {s.i, s.q * cos_twice + s.u * sin_twice, s.u * cos_twice - s.q * sin_twice, s.v};
}

}  // namespace abbe
