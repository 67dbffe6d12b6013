#pragma once

#include "materials/interface/coating.h"
#include "materials/interface/complex.h"

namespace abbe {

/// n + ik of a surface under a coating, relative to what its light comes from: of a bare one what the
/// catalogued index is relative to; of a coated one air, as its layers may be catalogued against another.
[[nodiscard]] inline Complex<double> surface_index(const RefractiveIndex& index, const Coating& coating,
                                                   double wavelength_nm) {
  if (coating.layers.empty()) return {index.catalogued_n(wavelength_nm), index.catalogued_k(wavelength_nm)};
  return {index.n(wavelength_nm), index.k(wavelength_nm)};
}

}  // namespace abbe
