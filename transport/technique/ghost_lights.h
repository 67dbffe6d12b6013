#pragma once

#include <cstdint>
#include <vector>

#include "sampling/sampler.h"
#include "transport/path/film_response.h"
#include "transport/path/ray_caster.h"
#include "transport/plan/plan.h"

namespace abbe {

/// What lights send straight into a lens and its ghosts bring to the film, which paths from the camera would
/// hardly ever find of small lights, and which techniques that start there leave to this: points of the lens
/// are connected to lights, and each lane of a connection falls where the ghost takes it. Serves one thread.
class GhostLights {
 public:
  GhostLights(const Plan& plan, RayCaster& caster);

  /// Whether there is anything to connect.
  [[nodiscard]] bool any() const { return any_; }

  /// Makes the connection of one sample of a pixel, if there is any, by its numbers and its wavelengths, and
  /// deposits it as of the path of that number; tells `apart`, unless it is empty, of which light it is.
  void connect(const Sampler& sampler, const SampledWavelengths& wavelengths, std::uint32_t path,
               const Deposit& deposit, const ContributionDeposit& apart);

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
