#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sampling/sampler.h"
#include "transport/path/random_walk.h"
#include "transport/path/ray_caster.h"
#include "transport/plan/plan.h"
#include "transport/technique/photon_start.h"

namespace abbe {

/// A photon under way through specular matter.
struct CausticPath : Walk {
  using Walk::Walk;
  PhotonStart start;
  float seen = 0;      ///< What its lanes carry is multiplied by to be as the sensor sees it.
  float distance = 0;  ///< It has come [m]; infinite from a light that is there.
};

/// Photons that are followed as long as every event is of a single direction, and tell where they come to
/// surfaces that scatter: what a `CausticGuide` learns from. Serves one thread.
class CausticPhotonTracer {
 public:
  using Path = CausticPath;
  static constexpr TransportMode kMode = TransportMode::power;

  struct Arrival {
    PhotonStart start;
    CausticPhoton photon;
  };

  /// `seen` says what the emission of each light is to the sensor; see `Emissions`. All must outlive it.
  CausticPhotonTracer(const Plan& plan, RayCaster& caster, const std::vector<double>& seen);

  /// Traces a photon for each of the samplers, and returns all that have arrived, in an order that depends on
  /// nothing else.
  [[nodiscard]] std::span<const Arrival> trace(std::span<const Sampler> photons);

  // What RandomWalks asks.
  void escape(CausticPath& /*path*/) {}
  void meet(CausticPath& /*path*/, const SurfaceHit& /*hit*/) {}
  void reach(CausticPath& path, const SurfaceVertex& vertex);
  void connect(CausticPath& /*path*/, const SurfaceVertex& /*vertex*/, const std::array<float, 4>& /*u*/) {}
  void connect_within(CausticPath& /*path*/, const PhaseFunction& /*phase*/,
                      const std::array<float, 4>& /*u*/) {}
  [[nodiscard]] std::optional<BsdfSample> scatter(const CausticPath& path, const SurfaceVertex& vertex,
                                                  const BsdfRandom& u) const {
    return vertex.scatter(u, path.packet.hero, kMode);
  }
  [[nodiscard]] bool follows(const CausticPath& /*path*/, const BsdfSample& event) const {
    return event.delta;
  }
  [[nodiscard]] bool follows_within(const CausticPath& /*path*/) const { return false; }
  [[nodiscard]] float kept(const CausticPath& /*path*/, const SurfaceVertex& /*vertex*/,
                           const BsdfSample& event) const {
    return kept_by(event);
  }
  [[nodiscard]] float kept_within(const CausticPath& /*path*/) const { return 1; }
  [[nodiscard]] float carried(const CausticPath& path) const { return path.packet.carried(); }
  void resolve_connections() {}

 private:
  const Plan& plan_;
  RayCaster& caster_;
  RandomWalks<CausticPhotonTracer> walks_;
  const std::vector<double>& seen_;
  std::vector<Arrival> arrivals_;
};

}  // namespace abbe
