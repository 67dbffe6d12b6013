#pragma once

#include "spectral/packet.h"

namespace abbe {

/// A Stokes vector (I, Q, U, V) at each lane, or the row of weights with which something measures one. It is
/// told in a frame across the light's way: `docs/physics/conventions.md` says what the signs mean.
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

/// What a row measures of a vector, both told in one frame.
[[nodiscard]] inline SampledSpectrum measured(const StokesSpectrum& row, const StokesSpectrum& vector) {
  return row.i * vector.i + row.q * vector.q + row.u * vector.u + row.v * vector.v;
}

/// The same vector, or row, told in a frame turned by an angle about the light's direction, right-handed; of
/// twice that angle the cosine and the sine. [Born1999, sec. 10.9]
[[nodiscard]] inline StokesSpectrum turned(const StokesSpectrum& s, float cos_twice, float sin_twice) {
  return {s.i, s.q * cos_twice + s.u * sin_twice, s.u * cos_twice - s.q * sin_twice, s.v};
}

}  // namespace abbe
