#pragma once

#include <memory>

#include "transport/plan/plan.h"

namespace abbe {

/// White of the light that exposes the film most. Lights with proportional spectra count as one. The measure
/// is luminance for an observer and for a spectral sensor, otherwise the sum of the film values of all
/// channels.
///
/// If the scene has several spectra, a pilot of few paths decides. Its random numbers depend on the scene
/// alone, so neither the seed of the render nor the order of the lights affects it. An exception are lights
/// that contribute equally within the noise of the pilot, about 1 %. The pilot uses `guides`, or trains them
/// if null.
///
/// The white is equal energy for a scene without lights. If the scene cannot be rendered (`refusal`), or no
/// light arrives at the film in the pilot, the strongest light decides. `threads` is at least 1 and does not
/// change the result. Throws Error{resource} if more than `MediumStack::kMaxShapes` media nest.
[[nodiscard]] White main_light(const Scene& scene, int threads = 1,
                               const std::shared_ptr<const GuidingData>& guides = {});

/// White that the scene requests, else that of `main_light`. Its spectrum is the one in which cameras are
/// characterised: that of the requested white if it has one, as a light of the scene does, else of
/// `main_light`. Arguments and errors are as for `main_light`.
[[nodiscard]] White white_of(const Scene& scene, int threads = 1,
                             const std::shared_ptr<const GuidingData>& guides = {});

}  // namespace abbe
