#pragma once

#include <optional>

#include "materials/bsdf/bsdf.h"
#include "materials/interface/mueller.h"

namespace abbe {

/// Mueller matrix of scattering between the local directions `wo` and `wi`, both pointing away from the
/// surface, about an axis in the same local frame. It is that of the delta lobe if `delta` is true, else that
/// of all other lobes. Empty if that lobe depolarises. The power is not included: it is in the event's weight
/// or in `eval`. If `lane` is given, only the elements of that wavelength sample are valid.
[[nodiscard]] std::optional<MuellerMatrix> mueller(const Bsdf& bsdf, const Imath::V3f& wo,
                                                   const Imath::V3f& wi, bool delta,
                                                   std::optional<int> lane = {});

}  // namespace abbe
