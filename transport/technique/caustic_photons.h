#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sampling/sampler.h"
#include "transport/path/path_batch.h"
#include "transport/path/ray_caster.h"
#include "transport/plan/plan.h"
#include "transport/technique/path_starts.h"

namespace abbe {

/// Photon on a specular path.
struct CausticPath : PathState {
  using PathState::PathState;
  PhotonStart start;  ///< Where the photon left its light.
  /// Factor from the photon's power to its power weighted by the sensor's response.
  float sensor_weight = 0;
  float distance = 0;  ///< Path length so far [m]; infinite for a light at infinity.
};

/// Photons that are traced as long as every event is a delta event. Their hits on scattering surfaces, after
/// one delta event or more, train a `CausticGuide`. One instance per thread.
class CausticPhotonTracer : public PathCallbacks<TransportMode::power> {
 public:
  using Path = CausticPath;

  /// Hit of a photon, with the start of the photon.
  struct TracedPhoton {
    PhotonStart start;
    CausticPhoton photon;  ///< Its power is not yet divided by the number of emitted photons.
  };

  /// `sensor_emissions` is `Emissions::sensor_emissions`, per light. All arguments must outlive the tracer.
  CausticPhotonTracer(const Plan& plan, RayCaster& caster, const std::vector<double>& sensor_emissions);

  /// Traces a photon for each sampler and returns the hits of all: none, one or several per photon. They and
  /// their order depend on plan and samplers alone. The span is valid until the next call. Throws
  /// Error{resource} if more than `MediumStack::kMaxShapes` media nest.
  [[nodiscard]] std::span<const TracedPhoton> trace(std::span<const Sampler> photons);

  // Callbacks (`PathCallbacks`).
  void prepare_scatter(CausticPath& path, const SurfaceVertex& vertex);
  [[nodiscard]] bool continues_after(const CausticPath& /*path*/, const BsdfSample& event) const {
    return event.delta;
  }
  [[nodiscard]] bool continues_in_medium(const CausticPath& /*path*/) const { return false; }

 private:
  const Plan& plan_;
  RayCaster& caster_;
  PathBatch<CausticPhotonTracer> batch_;
  const std::vector<double>& sensor_emissions_;
  std::vector<TracedPhoton> traced_photons_;
};

}  // namespace abbe
