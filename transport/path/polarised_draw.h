#pragma once

#include "materials/medium/phase.h"
#include "transport/path/vertex.h"

namespace abbe {

/// Sampling of events with the distribution of polarised light. With that of unpolarised light each event
/// would multiply the throughput by a factor f of mean 1 and at most 2. The variance of a long path, as of
/// light reflected within glass or scattered in a cloud, would grow exponentially. Without absorption, the
/// unpolarised pdf times the hero's f is a pdf, and is sampled instead. The ratio of wavelength k's f to the
/// hero's remains, in the throughput and in the pdf of that wavelength.

/// True if the model's events are sampled with polarised pdfs: smooth glass, which reflects or refracts.
[[nodiscard]] bool samples_polarised(const Bsdf& bsdf);

/// Probability that such a model reflects the packet, with `lane` as the hero. The path arrives along the
/// unit vector `along`.
[[nodiscard]] float polarised_reflectance(const PathPacket& packet, const SurfaceVertex& vertex,
                                          const Imath::V3f& along, TransportMode mode, int lane);

/// Maps a random number `u` in [0, 1) so that the model's unpolarised choice between reflection and
/// refraction follows the polarised probabilities. The path arrives along the unit vector `along`.
[[nodiscard]] float polarised_choice(const PathPacket& packet, const SurfaceVertex& vertex,
                                     const Imath::V3f& along, TransportMode mode, float u);

/// Direction sampled from a phase function for polarised light, in the world, and the unpolarised pdf of that
/// direction [1/sr]. The scattering angle is sampled as for unpolarised light. With f = 1 + A cos 2 phi + B
/// sin 2 phi of the azimuth phi, the azimuth solves phi + [A sin 2 phi + B (1 - cos 2 phi)]/2 = 2 pi u.
struct PolarisedDirection {
  Imath::V3f direction;
  float pdf;
};
[[nodiscard]] PolarisedDirection sample_polarised_phase(const PathPacket& packet, const PhaseFunction& phase,
                                                        const Imath::V3f& along, TransportMode mode,
                                                        const Imath::V2f& u);

/// Like `polarise`, for an event sampled with polarised pdfs. Returns the hero's factor f.
float polarise_sampled(PathPacket& packet, const std::optional<MuellerMatrix>& matrix,
                       const Imath::V3f& travels, TransportMode mode);

}  // namespace abbe
