#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sampling/sampler.h"
#include "transport/path/film_response.h"
#include "transport/path/path_batch.h"
#include "transport/path/path_recorder.h"
#include "transport/plan/plan.h"
#include "transport/technique/ghost_lights.h"
#include "transport/technique/path.h"
#include "transport/technique/photon_map.h"

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
class PhotonTracer : public PathCallbacks<TransportMode::power> {
 public:
  using Path = RecordedPath;

  /// Plan and caster must outlive the tracer.
  PhotonTracer(const Plan& plan, RayCaster& caster);

  /// Traces a path with the given packet and time (fraction of the exposure) for each sampler and appends its
  /// photons to `photons`, by path and then by depth. Throws Error{resource} if more than
  /// `MediumStack::kMaxShapes` media nest.
  void trace(std::span<const Sampler> samplers, const PathPacket& packet, float time,
             std::vector<Photon>& photons);

  // Callbacks (`PathCallbacks`).
  void connect(RecordedPath& path, const SurfaceVertex& vertex, const std::array<float, 4>& u);
  void connect_in_medium(RecordedPath& path, const PhaseFunction& phase, const std::array<float, 4>& u);
  [[nodiscard]] bool continues_after(RecordedPath& path, const BsdfSample& event) {
    if (!event.delta) scattered_[path.index] = true;
    return true;
  }

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

/// Photons of a density estimate: all within a radius, or a number of nearest ones.
struct GatherKernel {
  float radius = 0;           ///< Radius [m].
  std::size_t nearest = 0;    ///< Number of nearest photons; 0 selects the radius.
  bool final_gather = false;  ///< Gathers one event later, except for caustic photons.
};

/// Gathering radius [m] of the sample of index `sample`, from 0. The first one is r_1 = `first_radius`. With
/// i = sample + 1 and a = 2/3:
///     r_i^2 = r_1^2 prod_{k=1}^{i-1} (k + a)/(k + 1).
/// The squared bias and the variance of the mean over i samples then decrease at the same rate [Knaus2011]
/// [Kaplanyan2013].
[[nodiscard]] float gather_radius(float first_radius, std::uint64_t sample);

/// Camera path that gathers photons.
struct GatherPath : RecordedPath {
  using RecordedPath::RecordedPath;
  bool final_gather = false;  ///< True after the surface at which only caustic photons are gathered.
  /// True after a non-delta event until a medium scatters the path; caustic photons then own its emitter
  /// hits.
  bool seeks_photons = false;
};

/// Photon density estimation [Jensen1996]. Camera paths continue from delta events and within media, and
/// gather photons at the first other surface. With a final gather they gather caustic photons there and all
/// photons at the next one. One instance per thread.
///
/// Path classes owned: all, except light of point, spot and directional lights that arrives by delta events
/// alone. The kernel blurs the estimate: it is consistent, not unbiased, if radii decrease.
class PhotonGatherer : public PathCallbacks<TransportMode::radiance>, public LayerSource {
 public:
  using Path = GatherPath;

  /// Plan and caster must outlive the gatherer.
  PhotonGatherer(const Plan& plan, RayCaster& caster);

  /// Traces a path for each sample, with packet and time of the photons. Deposits each sum under its sample's
  /// index in `samples`, as the value of one sample per pixel. Throws
  /// Error{resource} if more than `MediumStack::kMaxShapes` media nest.
  void trace(std::span<const PixelSample> samples, const PhotonCloud& cloud, const GatherKernel& kernel,
             const Deposit& deposit);

  // Callbacks (`PathCallbacks`).
  void on_escape(GatherPath& path);
  void on_hit(GatherPath& path, const SurfaceHit& hit);
  void connect(GatherPath& path, const SurfaceVertex& vertex, const std::array<float, 4>& u);
  void connect_in_medium(GatherPath& path, const PhaseFunction& phase, const std::array<float, 4>& u);
  [[nodiscard]] bool continues_after(GatherPath& path, const BsdfSample& event) const;
  [[nodiscard]] bool continues_in_medium(GatherPath& path) const {
    path.seeks_photons = false;
    return true;
  }
  [[nodiscard]] float survival_weight(GatherPath& path, const SurfaceVertex& vertex,
                                      const BsdfSample& event) const {
    path.eta_scale *= vertex.squared_eta(event, path.packet.hero);
    return path.throughput_estimate();
  }
  [[nodiscard]] float survival_weight_in_medium(const GatherPath& path) const {
    return path.throughput_estimate();
  }

 private:
  void trace_batch(std::span<const PixelSample> samples);
  void connect_to_light(GatherPath& path, const PathVertex& vertex, const std::array<float, 4>& u);
  void connect_probe(GatherPath& path);
  void add(const GatherPath& path, const ContributionInfo& info, const SampledSpectrum& contribution,
           const StokesSpectrum* measured);
  template <typename Contribution, typename DepositAt>
  void expose(const GatherPath& path, const FilmPoint& at, const Contribution& contribution,
              DepositAt deposit);
  template <typename Contribution>
  void expose(const GatherPath& path, const FilmPoint& at, const Contribution& contribution);
  template <typename Contribution>
  void deposit_to_layer(const GatherPath& path, const FilmPoint& at, const ContributionInfo& info,
                        const Contribution& contribution);
  void gather(GatherPath& path, const SurfaceVertex& vertex);
  void gather(const Photon& photon, const GatherPath& path, const SurfaceVertex& vertex, float per_area);
  void add_emission(GatherPath& path, const LightVertex& light);
  [[nodiscard]] float connection_mis_weight(const PathVertex& probe, const PathVertex& light) const;

  const Plan& plan_;
  const Scene& scene_;
  RayCaster& caster_;
  bool probe_;  // the camera is a probe
  int max_depth_;
  FilmResponse response_;
  PathBatch<PhotonGatherer> batch_;
  GhostLights ghosts_;
  const PhotonCloud* cloud_ = nullptr;
  GatherKernel kernel_;
  const Deposit* deposit_ = nullptr;
  std::uint32_t first_ = 0;               // index of the first sample of the batch
  std::vector<FilmPoint> film_points_;    // film point of each sample
  std::vector<WavelengthImages> images_;  // film position per wavelength, for lenses that disperse them
  PathRadiance radiance_;                 // sums of each sample
  std::vector<std::uint32_t> nearby_;     // photons near the current point
};

}  // namespace abbe
