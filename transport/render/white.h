#pragma once

#include <memory>

#include "transport/plan/plan.h"

namespace abbe {

/// The light that exposes the film most, lamps whose spectra differ by a factor counting as one: by
/// luminance for the observer and for a spectral sensor, else by the sum of the film values of all channels.
/// Where there are several spectra a pilot tells, a render of few paths whose random numbers depend on the
/// scene alone. So the render's seed does not matter; nor does the order of the lights, but between lights
/// that give the film the same within the pilot's noise, about a percent. Equal energy for a scene without a
/// light; the strongest where no photons can light the scene (`refusal`). The pilot has the guides of the
/// scene that are given, else learns them.
[[nodiscard]] White main_light(const Scene& scene, int threads = 1,
                               const std::shared_ptr<const Guides>& guides = {});

/// The white the scene asks for, else the main light; with the spectrum that cameras are characterised in:
/// that of the white if it is a light of the scene, else of the main light.
[[nodiscard]] White white_of(const Scene& scene, int threads = 1,
                             const std::shared_ptr<const Guides>& guides = {});

}  // namespace abbe
