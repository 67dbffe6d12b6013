#pragma once

#include <cstdint>
#include <vector>

#include "sampling/sampler.h"
#include "transport/path/film_response.h"
#include "transport/path/ray_caster.h"
#include "transport/plan/plan.h"

namespace abbe {

/// Direct light on the lens that its ghosts send to the film. Camera paths hardly ever hit small lights by
/// way of a ghost, and leave these contributions to this class. It connects points of the lens to lights;
/// each wavelength falls where the ghost sends it. One instance per thread.
class GhostLights {
 public:
  /// Plan and caster must outlive it.
  GhostLights(const Plan& plan, RayCaster& caster);

  /// True if the camera has ghosts and a light can be sampled; otherwise `connect` does nothing.
  [[nodiscard]] bool any() const { return any_; }

  /// Makes the connection of one sample of a pixel, with its random numbers and wavelengths. Deposits it
  /// under the index `path`, at the pixels to which the ghost sends it. Deposits nothing if the light is
  /// occluded. Values are those of one sample per pixel. `layer_sink` may be empty. Throws Error{resource} if
  /// more than `MediumStack::kMaxShapes` media nest.
  void connect(const Sampler& sampler, const SampledWavelengths& wavelengths, std::uint32_t path,
               const Deposit& deposit, const ContributionDeposit& layer_sink);

 private:
  const Plan& plan_;
  const Scene& scene_;
  RayCaster& caster_;
  bool any_;
  FilmResponse response_;
  bool carries_polarisation_;
  bool measures_polarisation_;
  float scale_;
};

}  // namespace abbe
