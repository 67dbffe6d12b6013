#pragma once

#include <ImathVec.h>

#include "materials/index/refractive_index.h"
#include "spectral/sampled_spectrum.h"

namespace abbe {

/// The complex index n + ik of a medium, divided by the real index n of the medium outside, at each
/// wavelength.
struct RelativeIndex {
  SampledSpectrum n, k;
  bool dispersive;  ///< True if n may differ between wavelengths.
};

/// The index of `inside` at the given wavelengths [nm in air], relative to `outside`, or to air if that is
/// nullptr. Equal indices on both sides give exactly 1.
[[nodiscard]] inline RelativeIndex relative_index(const RefractiveIndex& inside,
                                                  const RefractiveIndex* outside,
                                                  const SampledSpectrum& wavelengths_nm) {
  const SampledSpectrum n = inside.n(wavelengths_nm);
  const SampledSpectrum k = inside.k(wavelengths_nm);
  if (outside == nullptr) return {n, k, inside.dispersive()};
  const SampledSpectrum n_outside = outside->n(wavelengths_nm);
  const SampledSpectrum relative = n / n_outside;
  return {relative, k / n_outside, !(relative - SampledSpectrum(relative[0])).is_zero()};
}

/// Surface position and wavelengths at which to evaluate scattering. It refers to the wavelengths, which must
/// outlive it.
struct SurfaceLookup {
  const SampledSpectrum& wavelengths_nm;  ///< Wavelengths in standard air [nm].
  Imath::V2f uv{0, 0};  ///< Surface coordinates (u, v); read only if the material `needs_coordinates`.
  const RefractiveIndex* outside = nullptr;  ///< Index outside the surface; nullptr is air.
};

}  // namespace abbe
