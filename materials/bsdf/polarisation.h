#pragma once

#include <optional>

#include "materials/bsdf/bsdf.h"
#include "materials/interface/mueller.h"

namespace abbe {

/// What the model does to polarisation between the local directions `wo` and `wi`, both away from the
/// surface, by one of its events of a single direction if `delta`, else by all others; nothing where it
/// depolarises. The axis is local too. What it does to unpolarised light is told by the event's weight, or by
/// `eval`. Where a path has one `lane` left, all elements may be those at that one.
[[nodiscard]] std::optional<MuellerMatrix> mueller(const Bsdf& bsdf, const Imath::V3f& wo,
                                                   const Imath::V3f& wi, bool delta,
                                                   std::optional<int> lane = {});

}  // namespace abbe
