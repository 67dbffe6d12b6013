#pragma once

#include <memory>
#include <optional>
#include <string>

#include "transport/plan/plan.h"

namespace abbe {

/// What a scene's integrator comes to, and why.
struct IntegratorChoice {
  Integrator integrator;
  std::string because;  ///< Empty where there was nothing to choose.
  /// What path tracing, with light tracing where the scene needs it, costs over what another way does at
  /// equal error, by pilots.
  std::optional<double> cost_ratio = {};
  Integrator other = Integrator::bdpt;  ///< That way.
  /// What pilots have taught of the scene on the way, for that integrator, as `RenderOptions` takes it.
  std::shared_ptr<const Guides> guides = {};
};

/// Chooses for a scene that leaves it to us (Integrator::automatic); of others it is theirs.
///
/// Where paths are left unreached that merging finds, and the scene allows what is consistent and not
/// unbiased, it is Integrator::vcm. Else pilots estimate for both what the error costs, sum V c with the
/// relative variance V of a sample's film values and the cost c of the sample: of camera paths with photons
/// beside them (sqrt(V c) + sqrt(V' c'))^2, as the best share of both has it. It is Integrator::bdpt where
/// that costs so much less that the pilots' noise does not make the difference, on a meter that photons run
/// into and where they reach everything Integrator::light likewise, else Integrator::automatic, as it is
/// where the film has so few pixels that pilots would not pay. A function of the scene alone, whatever its
/// seed and samples, and the threads. Never throws what `make_plan` does: there it is Integrator::automatic,
/// or on a meter Integrator::path where that is not refused.
[[nodiscard]] IntegratorChoice choose_integrator(const Scene& scene, int threads);

}  // namespace abbe
