#pragma once

#include <optional>

#include "materials/medium/phase.h"
#include "scene/scene.h"
#include "transport/path/path_state.h"
#include "transport/path/vertex.h"

namespace abbe {

/// True if the scene's paths carry polarisation and a channel of its sensor distinguishes it.
[[nodiscard]] bool measures_polarisation(const Scene& scene);

/// Rows of the scene's sensor for light that arrives along the unit vector `travels` at the time `time`, a
/// fraction of the exposure. These are the rows of all four elements in the frame of the film, or that of
/// power alone if the sensor measures no more. `images` is the effect of a lens that disperses wavelengths,
/// nullptr for other lenses.
[[nodiscard]] Polarisation polarisation_of_film(const Scene& scene, const Imath::V3f& travels, float time,
                                                const WavelengthImages* images);

/// Polarisation of a light's emission along the unit vector `travels`.
[[nodiscard]] Polarisation emitted_polarisation(const Light& light, const Imath::V3f& travels);

/// Stokes vector that a camera packet measures of a light that it sees in the unit direction `towards`,
/// relative to unpolarised light and a packet without polarisation. Nothing if the packet carries none.
[[nodiscard]] std::optional<StokesSpectrum> measured_emission(const Light& light, const PathPacket& packet,
                                                              const Imath::V3f& towards);

/// Stokes vector that the film measures of a light packet that arrives along the unit vector `travels`,
/// relative to a packet without polarisation. Nothing if the packet carries none. `images` is as for
/// `polarisation_of_film`.
[[nodiscard]] std::optional<StokesSpectrum> measured_on_film(const Scene& scene, const PathPacket& packet,
                                                             const Imath::V3f& travels, float time,
                                                             const WavelengthImages* images);

/// Pointer to the value, or nullptr.
[[nodiscard]] inline const StokesSpectrum* pointer_to(const std::optional<StokesSpectrum>& of) {
  return of ? &*of : nullptr;
}

/// Calls `use` with a contribution to the film. Without polarisation (`stokes` is nullptr) this is the power
/// `contribution`. Otherwise `stokes` is measured of a contribution of 1: `use` receives the scaled Stokes
/// vector if the sensor `measures` those, or else its intensity.
template <typename Use>
void with_measurement(bool measures, const SampledSpectrum& contribution, const StokesSpectrum* stokes,
                      Use use) {
  if (stokes == nullptr)
    use(contribution);
  else if (measures)
    use(*stokes * contribution);
  else
    use(contribution * stokes->i);
}

/// Sampling of events with the distribution of polarised light. With that of unpolarised light each event
/// would multiply the throughput by a factor f of mean 1 and at most 2. The variance of a long path, as of
/// light reflected within glass or scattered in a cloud, would grow exponentially. Without absorption, the
/// unpolarised pdf times the hero's f is a pdf, and is sampled instead. The ratio of wavelength k's f to the
/// hero's remains, in the throughput and in the pdf of that wavelength.

/// True if the model's events are sampled with polarised pdfs: smooth glass, which reflects or refracts.
[[nodiscard]] bool samples_polarised(const Bsdf& bsdf);

/// Probability that the model of `vertex`, for which `samples_polarised` must be true, reflects the packet
/// with `lane` as the hero. The packet must carry a polarisation. The path arrives along the unit vector
/// `along`.
[[nodiscard]] float polarised_reflectance(const PathPacket& packet, const SurfaceVertex& vertex,
                                          const Imath::V3f& along, TransportMode mode, int lane);

/// Maps a random number `u` in [0, 1) so that the model's unpolarised choice between reflection and
/// refraction follows the polarised probabilities of the hero. Returns a number in [0, 1). Other arguments
/// are as for `polarised_reflectance`.
[[nodiscard]] float polarised_choice(const PathPacket& packet, const SurfaceVertex& vertex,
                                     const Imath::V3f& along, TransportMode mode, float u);

/// Direction sampled from a phase function for polarised light.
struct PolarisedDirection {
  Imath::V3f direction;  ///< Unit vector in world space.
  float pdf;             ///< Unpolarised pdf of the direction [1/sr].
};
/// Samples a direction for a packet that arrives along the unit vector `along`, with `u` in [0, 1)^2. The
/// packet must carry a polarisation. The scattering angle follows u_x as for unpolarised light. The hero's f
/// is 1 + A cos 2 phi + B sin 2 phi of the azimuth phi, which solves phi + [A sin 2 phi + B (1 - cos 2
/// phi)]/2 = 2 pi u_y.
[[nodiscard]] PolarisedDirection sample_polarised_phase(const PathPacket& packet, const PhaseFunction& phase,
                                                        const Imath::V3f& along, TransportMode mode,
                                                        const Imath::V2f& u);

/// Like `polarise`, for an event sampled with polarised pdfs. Returns the hero's factor f.
float polarise_sampled(PathPacket& packet, const std::optional<MuellerMatrix>& matrix,
                       const Imath::V3f& travels, TransportMode mode);

}  // namespace abbe
