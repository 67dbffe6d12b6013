#pragma once

#include <ImathVec.h>

#include "materials/index/refractive_index.h"
#include "spectral/sampled_spectrum.h"

namespace abbe {

/// Surface position and wavelengths at which to evaluate scattering.
struct SurfaceLookup {
  const SampledSpectrum& wavelengths_nm;
  Imath::V2f uv{0, 0};                       ///< Surface coordinates, set if the material needs them.
  const RefractiveIndex* outside = nullptr;  ///< Index outside the surface; nullptr is air.
};

/// Kinds of lobes into which a material scatters. Black materials have none.
struct Lobes {
  bool delta = false;  ///< True for single directions, as of mirrors and smooth glass, which may focus light.
  bool spread = false;  ///< True for directions of finite pdf, to which next-event estimation applies.
};

}  // namespace abbe
