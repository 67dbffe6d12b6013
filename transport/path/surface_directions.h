#pragma once

#include <optional>

#include "transport/path/vertex.h"

namespace abbe {

/// Sampling of directions at a surface independently of its BSDF: by the cosine with the shading normal, or
/// uniformly. Both sides are sampled if the surface transmits. `DirectionSampling::bsdf` is not allowed. Let
/// q_k be the probability that wavelength k's event is delta, and p(wi) the pdf of DirectionSampling. The pdf
/// of a direction is
///     P_k(wi) = (1 - q_k) p(wi),
/// and the weight of an event is f |cos wi| / P_hero. Surfaces with delta distributions only are sampled by
/// their BSDF.

/// P_k(wi) [1/sr] per wavelength, for a local unit direction. 0 on the far side of a surface that does not
/// transmit.
[[nodiscard]] SampledSpectrum pdf_of_directions(DirectionSampling directions, const SurfaceVertex& vertex,
                                                const Imath::V3f& wi);

/// Samples an event with the hero wavelength: the BSDF's own if that is delta, otherwise one with the pdf
/// P_hero(wi). Returns nothing if the surface scatters no light there. `mode` is the quantity that the path
/// carries.
[[nodiscard]] std::optional<BsdfSample> sample_directions(DirectionSampling directions,
                                                          const SurfaceVertex& vertex, const BsdfRandom& u,
                                                          int hero, TransportMode mode);

}  // namespace abbe
