#pragma once

#include <optional>

#include "materials/bsdf/bsdf.h"
#include "materials/interface/mueller.h"

namespace abbe {

/// Mueller matrix of scattering between the local directions `wo` and `wi`, both pointing away from the
/// surface, about a local axis. It is that of the delta lobe if `delta` is true, else that of all other
/// lobes. Empty if the model depolarises. The power is not included: it is in the event's weight or in
/// `eval`. If `lane` is given, all elements may hold the values at that wavelength sample.
[[nodiscard]] std::optional<MuellerMatrix> mueller(const Bsdf& bsdf, const Imath::V3f& wo,
                                                   const Imath::V3f& wi, bool delta,
                                                   std::optional<int> lane = {});

}  // namespace abbe
