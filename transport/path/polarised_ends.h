#pragma once

#include <optional>

#include "scene/scene.h"
#include "transport/path/packet.h"

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

}  // namespace abbe
