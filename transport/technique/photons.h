#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sampling/sampler.h"
#include "transport/path/path_batch.h"
#include "transport/path/path_recorder.h"
#include "transport/path/photon_map.h"
#include "transport/plan/plan.h"

namespace abbe {

/// Photon stored on a scattering surface.
struct Photon {
  Imath::V3f point;
  Imath::V3f normal;         ///< Outward unit geometric normal of the surface.
  Imath::V3f from;           ///< Unit direction towards its origin.
  SampledSpectrum power;     ///< `PathPacket::throughput`: spectral flux, not divided by the number of paths.
  SampledSpectrum lane_pdf;  ///< See `PathPacket`.
  int depth;                 ///< Number of scattering events before this surface.
  std::uint32_t light;       ///< Index into `Scene::lights`.
  bool caustic;              ///< True if all events before were delta events.
  CarriedPolarisation polarisation = {};  ///< Polarisation on arrival; empty if the scene carries none.
};

/// Light paths that store photons at every scattering surface except the first, where camera paths connect to
/// the light themselves [Jensen1996]. One instance per thread.
class PhotonTracer {
 public:
  using Path = RecordedPath;
  static constexpr TransportMode kMode = TransportMode::power;

  /// Plan and caster must outlive the tracer.
  PhotonTracer(const Plan& plan, RayCaster& caster);

  /// Traces a path with the given packet and time (fraction of the exposure) for each sampler and appends its
  /// photons to `photons`, by path and then by depth. Throws Error{resource} if more than
  /// `MediumStack::kMaxShapes` media nest.
  void trace(std::span<const Sampler> samplers, const PathPacket& packet, float time,
             std::vector<Photon>& photons);

  // Interface of PathTechnique.
  void on_escape(RecordedPath& /*path*/) {}
  void on_hit(RecordedPath& /*path*/, const SurfaceHit& /*hit*/) {}
  void prepare_scatter(RecordedPath& /*path*/, const SurfaceVertex& /*vertex*/) {}
  void connect(RecordedPath& path, const SurfaceVertex& vertex, const std::array<float, 4>& u);
  void connect_in_medium(RecordedPath& path, const PhaseFunction& phase, const std::array<float, 4>& u);
  [[nodiscard]] std::optional<BsdfSample> scatter(const RecordedPath& path, const SurfaceVertex& vertex,
                                                  const BsdfRandom& u) const {
    return vertex.scatter(u, path.packet.hero, kMode);
  }
  [[nodiscard]] bool continues_after(RecordedPath& path, const BsdfSample& event) {
    if (!event.delta) scattered_[path.index] = true;
    return true;
  }
  [[nodiscard]] bool continues_in_medium(const RecordedPath& /*path*/) const { return true; }
  // Roulette uses the throughput of the event, as in light tracing.
  [[nodiscard]] float survival_weight(const RecordedPath& /*path*/, const SurfaceVertex& /*vertex*/,
                                      const BsdfSample& event) const {
    return event_throughput(event);
  }
  [[nodiscard]] float survival_weight_in_medium(const RecordedPath& /*path*/) const { return 1; }
  [[nodiscard]] float throughput_estimate(const RecordedPath& path) const {
    return path.throughput_estimate();
  }
  void resolve_connections() {}

 private:
  struct PathPhoton {
    std::uint32_t path;
    Photon photon;
  };

  const Plan& plan_;
  RayCaster& caster_;
  PathBatch<PhotonTracer> batch_;
  std::vector<bool> scattered_;           // per path: has had an event that is not delta
  std::vector<PathPhoton> path_photons_;  // photons of the current paths
};

/// Photons of a sample with their spatial index.
struct PhotonCloud {
  /// Builds the index of `stored_photons`, which `traced` paths stored.
  PhotonCloud(std::vector<Photon> stored_photons, std::uint64_t traced, const PathPacket& start_packet,
              float start_time);

  std::vector<Photon> photons;
  PhotonMap map;        ///< Positions of `photons`, with the same numbers.
  std::uint64_t paths;  ///< Number of paths traced for them.
  PathPacket packet;    ///< Initial packet of all paths.
  float time;           ///< Time of all paths, a fraction of the exposure.
};

}  // namespace abbe
