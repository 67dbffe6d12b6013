#pragma once

#include <memory>
#include <optional>
#include <string>

#include "transport/plan/plan.h"

namespace abbe {

/// Integrator with which a scene is rendered, and the reason for it.
struct IntegratorChoice {
  Integrator integrator;  ///< Value for `RenderSettings::integrator` of the scene.
  std::string reason;     ///< Empty if the result is the scene's own setting.
  /// Cost of path tracing, with light tracing if the plan has it, divided by the cost of `alternative` at
  /// equal error. Pilots estimate it; empty if they were not run.
  std::optional<double> cost_ratio = {};
  /// Integrator with which the pilots compared path tracing.
  Integrator alternative = integrator_for(AutomaticChoice::films);
  /// Guiding data that pilots trained for `integrator`, to be passed on as `RenderOptions::guides`. Null if
  /// they trained none for it; the render then trains its own.
  std::shared_ptr<const GuidingData> guides = {};
};

/// Chooses the integrator of a scene with Integrator::automatic. A scene that names its integrator is
/// rendered with it.
///
/// - `AutomaticChoice::consistent` if the scene allows consistent estimators (biased, converging) and photon
///   merging samples light paths that cannot be sampled otherwise.
/// - `AutomaticChoice::probes` for a probe that photons can hit, if it samples all light and is cheaper.
/// - `AutomaticChoice::films` for all other sensors, if it is cheaper.
/// - Integrator::automatic otherwise, and for films so small that pilots would cost more than they save.
///
/// Pilots estimate the cost of error, sum V c, with the relative variance V of a sample's film values and its
/// cost c in rays. Camera paths combined with photons cost (sqrt(V c) + sqrt(V' c'))^2, the minimum over all
/// allocations. An alternative is cheaper if it saves more than the noise of the pilots explains.
///
/// The result depends on the scene alone, not on its seed, its samples or `threads`, which is at least 1. A
/// scene that `make_plan` rejects with Error{scene} throws nothing here. The result is then the scene's own
/// integrator, or path tracing for a probe if that is possible. Throws Error{resource} if more than
/// `MediumStack::kMaxShapes` media nest.
[[nodiscard]] IntegratorChoice choose_integrator(const Scene& scene, int threads);

}  // namespace abbe
