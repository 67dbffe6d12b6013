#pragma once

#include <ImathVec.h>

#include "materials/index/refractive_index.h"
#include "spectral/sampled_spectrum.h"

namespace abbe {

/// Surface position and wavelengths at which to evaluate scattering. It refers to the wavelengths, which must
/// outlive it.
struct SurfaceLookup {
  const SampledSpectrum& wavelengths_nm;  ///< Wavelengths in standard air [nm].
  Imath::V2f uv{0, 0};  ///< Surface coordinates (u, v); read only if the material `needs_coordinates`.
  const RefractiveIndex* outside = nullptr;  ///< Index outside the surface; nullptr is air.
};

/// Kinds of lobes into which a material may scatter, by its model alone: a black diffuse material has a
/// spread lobe. The boundary of a medium without an interface has none.
struct Lobes {
  bool delta = false;  ///< True for single directions, as of mirrors and smooth glass, which may focus light.
  bool spread = false;  ///< True for directions of finite pdf, to which next-event estimation applies.
};

}  // namespace abbe
