#pragma once

#include <optional>

#include "scene/scene.h"
#include "transport/path/packet.h"

namespace abbe {

/// Whether a channel of the scene's sensor tells polarised light from unpolarised light, and paths carry it.
[[nodiscard]] bool measures_polarisation(const Scene& scene);

/// The rows of the scene's sensor for light that comes in along the unit vector `travels` at that time: those
/// of all four elements in the frame of the film, or of power alone where that is all it measures; through a
/// lens that takes lanes to `images`, which is nullptr without one, as that changes them.
[[nodiscard]] Polarisation polarisation_of_film(const Scene& scene, const Imath::V3f& travels, float time,
                                                const LaneImages* images);

/// That of light which leaves a lamp along the unit vector `travels`.
[[nodiscard]] Polarisation polarisation_of_lamp(const Light& light, const Imath::V3f& travels);

/// What a packet from the camera measures of a light that it meets along the unit vector `towards`, over what
/// it would measure of unpolarised light did it carry no polarisation; nothing if it carries none.
[[nodiscard]] std::optional<StokesSpectrum> seen_of(const Light& light, const PathPacket& packet,
                                                    const Imath::V3f& towards);

/// What the film measures of a packet from a light that comes in along the unit vector `travels`, as
/// `polarisation_of_film` has it, over what it would measure did the packet carry no polarisation; nothing if
/// it carries none.
[[nodiscard]] std::optional<StokesSpectrum> seen_on_film(const Scene& scene, const PathPacket& packet,
                                                         const Imath::V3f& travels, float time,
                                                         const LaneImages* images);

/// Nothing of what is not there.
[[nodiscard]] inline const StokesSpectrum* pointer_to(const std::optional<StokesSpectrum>& of) {
  return of ? &*of : nullptr;
}

/// Calls `use` with a contribution to the film, `contribution` as power alone if nothing is carried, else
/// what the sensor measures, `seen` being that of a contribution of 1: a Stokes vector if it `measures`
/// those.
template <typename Use>
void with_seen(bool measures, const SampledSpectrum& contribution, const StokesSpectrum* seen, Use use) {
  if (seen == nullptr)
    use(contribution);
  else if (measures)
    use(*seen * contribution);
  else
    use(contribution * seen->i);
}

}  // namespace abbe
