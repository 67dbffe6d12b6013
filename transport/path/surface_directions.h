#pragma once

#include <optional>

#include "transport/path/vertex.h"

namespace abbe {

/// Directions at a surface that are not drawn by its scattering. With q_k the probability that lane k's event
/// is delta there and p(wi) the density of DirectionSampling, the density of a direction is
///     P_k(wi) = (1 - q_k) p(wi),
/// and the weight of an event f |cos wi| / P_hero. Surfaces of single directions alone are left as they are.

/// P_k(wi) [1/sr] of each lane, for a local direction.
[[nodiscard]] SampledSpectrum pdf_of_directions(DirectionSampling directions, const SurfaceVertex& vertex,
                                                const Imath::V3f& wi);

/// An event so drawn: the surface's own where that is delta; nothing where no light goes.
[[nodiscard]] std::optional<BsdfSample> sample_directions(DirectionSampling directions,
                                                          const SurfaceVertex& vertex, const BsdfRandom& u,
                                                          int hero, TransportMode mode);

}  // namespace abbe
