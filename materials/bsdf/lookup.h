#pragma once

#include <ImathVec.h>

#include "materials/index/refractive_index.h"
#include "spectral/packet.h"

namespace abbe {

/// Where on a surface, and at which wavelengths, its scattering is asked for.
struct SurfaceLookup {
  const SampledSpectrum& wavelengths_nm;
  Imath::V2f uv{0, 0};                       ///< Surface coordinates, known where a material asks for them.
  const RefractiveIndex* outside = nullptr;  ///< Of the matter the surface's own is in; nullptr is air.
};

/// Tells in which ways a material sends light on; black matter in none.
struct Lobes {
  bool delta = false;   ///< In single directions, as mirrors and smooth glass do: light may be focused.
  bool spread = false;  ///< In all directions of some range: connecting to lights pays.
};

}  // namespace abbe
