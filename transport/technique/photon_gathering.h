#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "transport/path/film_response.h"
#include "transport/path/found_light.h"
#include "transport/path/path_recorder.h"
#include "transport/path/random_walk.h"
#include "transport/plan/plan.h"
#include "transport/technique/ghost_lights.h"
#include "transport/technique/path.h"
#include "transport/technique/photons.h"

namespace abbe {

/// Over which photons an estimate is made: those within a radius, or so many nearest ones.
struct GatherKernel {
  float radius = 0;
  std::size_t nearest = 0;    ///< 0: by the radius.
  bool final_gather = false;  ///< One event later, but for photons of caustics.
};

/// The radius of gathering of the sample with that number, from 0: r_i^2 = r_1^2 prod_{k<i} (k + a)/(k + 1)
/// with a = 2/3, which lets the squared bias and the variance of the mean over i samples shrink alike
/// [Knaus2011] [Kaplanyan2013].
[[nodiscard]] float gather_radius(float first_radius, std::uint64_t sample);

/// A path from the camera that gathers photons, under way.
struct GatherPath : RecordedPath {
  using RecordedPath::RecordedPath;
  bool final_gather = false;  ///< It has left the surface where only photons of caustics are gathered,
  /// and since then no matter has scattered it: of light that it meets those photons have told.
  bool seeks_photons = false;
};

/// Photon density estimation [Jensen1996]: paths from the camera go on from events of a single direction and
/// within matter, and gather photons at the first surface that scatters otherwise; or, with a final gather,
/// those of caustics there and all at the next. Serves one thread.
///
/// Owned: everything but what comes to a point, spot or directional light by events of a single direction
/// alone. The estimate is blurred by the kernel: it is consistent, not unbiased, where radii shrink.
class PhotonGatherer {
 public:
  using Path = GatherPath;
  static constexpr TransportMode kMode = TransportMode::radiance;

  PhotonGatherer(const Plan& plan, RayCaster& caster);

  /// Lets the gatherer, from now on, also tell each contribution by itself, whose sum it deposits.
  void tell_apart(ContributionDeposit deposit) { apart_ = std::move(deposit); }

  /// Traces a path for each of some samples, of the packet of the photons, and deposits what they find by
  /// their numbers.
  void trace(std::span<const PixelSample> samples, const PhotonCloud& cloud, const GatherKernel& kernel,
             const Deposit& deposit);

  // What RandomWalks asks.
  void escape(GatherPath& path);
  void meet(GatherPath& path, const SurfaceHit& hit);
  void reach(GatherPath& /*path*/, const SurfaceVertex& /*vertex*/) {}
  void connect(GatherPath& path, const SurfaceVertex& vertex, const std::array<float, 4>& u);
  void connect_within(GatherPath& path, const PhaseFunction& phase, const std::array<float, 4>& u);
  [[nodiscard]] std::optional<BsdfSample> scatter(const GatherPath& path, const SurfaceVertex& vertex,
                                                  const BsdfRandom& u) const {
    return vertex.scatter(u, path.packet.hero, kMode);
  }
  [[nodiscard]] bool follows(GatherPath& path, const BsdfSample& event) const;
  [[nodiscard]] bool follows_within(GatherPath& path) const {
    path.seeks_photons = false;
    return true;
  }
  [[nodiscard]] float kept(GatherPath& path, const SurfaceVertex& vertex, const BsdfSample& event) const {
    path.eta_scale *= vertex.squared_eta(event, path.packet.hero);
    return carried(path);
  }
  [[nodiscard]] float kept_within(const GatherPath& path) const { return carried(path); }
  [[nodiscard]] float carried(const GatherPath& path) const { return path.carried(); }
  void resolve_connections() {}

 private:
  void trace_together(std::span<const PixelSample> samples);
  void connect_to_light(GatherPath& path, const PathVertex& vertex, const std::array<float, 4>& u);
  void connect_meter(GatherPath& path);
  void add(const GatherPath& path, const LightHistory& of, const SampledSpectrum& contribution,
           const StokesSpectrum* seen);
  template <typename Contribution, typename DepositAt>
  void expose(const GatherPath& path, const FilmPoint& at, const Contribution& contribution,
              DepositAt deposit);
  template <typename Contribution>
  void expose(const GatherPath& path, const FilmPoint& at, const Contribution& contribution);
  template <typename Contribution>
  void expose_apart(const GatherPath& path, const FilmPoint& at, const LightHistory& of,
                    const Contribution& contribution);
  void gather(GatherPath& path, const SurfaceVertex& vertex);
  void gather(const Photon& photon, const GatherPath& path, const SurfaceVertex& vertex, float per_area);
  void add_met(GatherPath& path, const LightVertex& light);
  [[nodiscard]] float share_of_connecting(const PathVertex& meter, const PathVertex& light) const;

  const Plan& plan_;
  const Scene& scene_;
  RayCaster& caster_;
  bool meter_;  // instead of a lens
  int most_events_;
  FilmResponse response_;
  RandomWalks<PhotonGatherer> walks_;
  GhostLights ghosts_;
  const PhotonCloud* cloud_ = nullptr;
  GatherKernel kernel_;
  const Deposit* deposit_ = nullptr;
  ContributionDeposit apart_;        // if it is told
  std::uint32_t first_ = 0;          // number of the first of the samples under way
  std::vector<FilmPoint> at_;        // where each exposes the film,
  std::vector<LaneImages> images_;   // and its lanes, behind a lens that displaces them,
  FoundLight found_;                 // and with what, balanced over lanes
  std::vector<std::uint32_t> near_;  // photons, at one place
};

}  // namespace abbe
