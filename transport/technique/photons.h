#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sampling/sampler.h"
#include "transport/path/path_recorder.h"
#include "transport/path/photon_map.h"
#include "transport/path/random_walk.h"
#include "transport/plan/plan.h"

namespace abbe {

/// What a path from a light brings to a surface that scatters.
struct Photon {
  Imath::V3f point;
  Imath::V3f normal;         ///< Of the surface, geometric.
  Imath::V3f from;           ///< The unit direction to where it came from.
  SampledSpectrum power;     ///< Throughput, over the densities of the hero: flux over wavelength.
  SampledSpectrum lane_pdf;  ///< See `PathPacket`.
  int events;                ///< That it has had before.
  std::uint32_t light;       ///< Where it comes from.
  bool caustic;              ///< They were of a single direction, all of them.
  CarriedPolarisation polarisation = {};
};

/// Paths from lights that leave photons at every surface that scatters, but for the first they come to, which
/// camera paths connect to the light themselves [Jensen1996]. Serves one thread.
class PhotonTracer {
 public:
  using Path = RecordedPath;
  static constexpr TransportMode kMode = TransportMode::power;

  PhotonTracer(const Plan& plan, RayCaster& caster);

  /// Traces a path of that packet and time for each of the samplers, and adds what they leave to `photons`,
  /// in an order that depends on nothing else.
  void trace(std::span<const Sampler> samplers, const PathPacket& packet, float time,
             std::vector<Photon>& photons);

  // What RandomWalks asks.
  void escape(RecordedPath& /*path*/) {}
  void meet(RecordedPath& /*path*/, const SurfaceHit& /*hit*/) {}
  void reach(RecordedPath& /*path*/, const SurfaceVertex& /*vertex*/) {}
  void connect(RecordedPath& path, const SurfaceVertex& vertex, const std::array<float, 4>& u);
  void connect_within(RecordedPath& path, const PhaseFunction& phase, const std::array<float, 4>& u);
  [[nodiscard]] std::optional<BsdfSample> scatter(const RecordedPath& path, const SurfaceVertex& vertex,
                                                  const BsdfRandom& u) const {
    return vertex.scatter(u, path.packet.hero, kMode);
  }
  [[nodiscard]] bool follows(RecordedPath& path, const BsdfSample& event) {
    if (!event.delta) scattered_[path.path] = true;
    return true;
  }
  [[nodiscard]] bool follows_within(const RecordedPath& /*path*/) const { return true; }
  // As in light tracing, roulette goes by what the event keeps.
  [[nodiscard]] float kept(const RecordedPath& /*path*/, const SurfaceVertex& /*vertex*/,
                           const BsdfSample& event) const {
    return kept_by(event);
  }
  [[nodiscard]] float kept_within(const RecordedPath& /*path*/) const { return 1; }
  [[nodiscard]] float carried(const RecordedPath& path) const { return path.carried(); }
  void resolve_connections() {}

 private:
  struct Left {
    std::uint32_t path;
    Photon photon;
  };

  const Plan& plan_;
  RayCaster& caster_;
  RandomWalks<PhotonTracer> walks_;
  std::vector<bool> scattered_;  // whether a path has had an event of more than a single direction
  std::vector<Left> left_;       // by the paths under way
};

/// The photons of a sample, to be gathered.
struct PhotonCloud {
  PhotonCloud(std::vector<Photon> left, std::uint64_t traced, const PathPacket& of, float at);

  std::vector<Photon> photons;
  PhotonMap map;
  std::uint64_t paths;  ///< That have been traced for them.
  PathPacket packet;    ///< That all set out with,
  float time;           ///< and when.
};

}  // namespace abbe
