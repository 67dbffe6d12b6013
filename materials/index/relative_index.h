#pragma once

#include "materials/index/refractive_index.h"

namespace abbe {

/// What a surface of an index means to light, lane by lane: its own n + ik over the real n of what is
/// outside.
struct RelativeIndex {
  SampledSpectrum n, k;
  bool dispersive;  ///< n differs between lanes, or may.
};

/// The n + ik of matter at some wavelengths, relative to what is `outside`, air if nullptr. The same index on
/// both sides gives exactly 1.
[[nodiscard]] inline RelativeIndex relative_index(const RefractiveIndex& inside,
                                                  const RefractiveIndex* outside,
                                                  const SampledSpectrum& wavelengths_nm) {
  const SampledSpectrum n = inside.n(wavelengths_nm);
  const SampledSpectrum k = inside.k(wavelengths_nm);
  if (outside == nullptr) return {n, k, inside.dispersive()};
  const SampledSpectrum around = outside->n(wavelengths_nm);
  const SampledSpectrum relative = n / around;
  return {relative, k / around, !(relative - SampledSpectrum(relative[0])).is_zero()};
}

}  // namespace abbe
