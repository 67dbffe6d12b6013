#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sampling/sampler.h"
#include "transport/path/film_response.h"
#include "transport/path/path_batch.h"
#include "transport/path/ray_caster.h"
#include "transport/plan/plan.h"
#include "transport/technique/path_starts.h"

namespace abbe {

/// Photon of the light tracer.
struct LightPath : PathState {
  using PathState::PathState;
  float power = 0;  ///< Largest throughput of a wavelength at the start.
  /// Hash of the specular events before the first event of another kind, and of their shapes.
  std::uint32_t branch = 0;
  bool scattered = false;  ///< True after an event that is not specular: the branch is complete.

  /// Throughput relative to that at the start.
  [[nodiscard]] float throughput_estimate() const { return packet.throughput_estimate() / power; }
  /// Adds an event at the shape of index `shape` to the branch by a step of the FNV-1a hash. After the first
  /// event that is not specular it does nothing.
  void extend_branch(std::uint32_t shape, const BsdfSample& event) {
    constexpr std::uint32_t kPrime = 16777619;
    scattered = scattered || !event.delta;
    if (!scattered) branch = (branch ^ (2 * shape + (event.transmitted ? 2U : 1U))) * kPrime;
  }
};

/// Light tracing [Arvo1986] from the lights that the plan traces, with a connection to the camera at every
/// non-specular vertex. Path tracing owns photons whose first vertex is not specular; these are traced only
/// if no other technique is in the plan. Photons expose a probe where they hit it: all of them without path
/// tracing, otherwise those whose last vertex is specular, and all of lights without area. If the plan
/// selects it, photons split into their wavelengths at dispersive glass. Deposited values are those of one
/// sample per pixel. One instance per thread.
class LightTracer : public PathCallbacks<TransportMode::power>, public LayerSource {
 public:
  using Path = LightPath;

  /// `sample_fraction` is the fraction of a sample per pixel that one photon represents: 1/pixels if a sample
  /// has one photon per pixel. With a `ball_radius` [m], photons that enter or start within the ball of that
  /// radius around the probe's center expose its first pixel instead. This measures the light that passes
  /// near the probe. Plan and caster must outlive the tracer.
  LightTracer(const Plan& plan, RayCaster& caster, double sample_fraction,
              std::optional<double> ball_radius = {});

  /// Traces a photon for each sampler and deposits its contributions under the photon's index in `photons`.
  /// The plan must have a light to trace. Throws Error{resource} if more than `MediumStack::kMaxShapes` media
  /// nest.
  void trace(std::span<const Sampler> photons, const Deposit& deposit);
  /// Starts of all photons of the last call, in the order of its samplers; valid until the next call.
  [[nodiscard]] std::span<const PhotonStart> starts() const { return starts_; }

  // Callbacks (`PathCallbacks`).
  void connect(LightPath& path, const SurfaceVertex& vertex, const std::array<float, 4>& u);
  void connect_in_medium(LightPath& path, const PhaseFunction& phase, const std::array<float, 4>& u);
  // Photons that scatter at their first vertex continue only if this technique owns them.
  [[nodiscard]] bool continues_after(const LightPath& path, const BsdfSample& event) const {
    return event.delta || owns(path);
  }
  [[nodiscard]] bool continues_in_medium(const LightPath& path) const { return owns(path); }
  // True if photons split into their wavelengths at dispersive glass.
  [[nodiscard]] bool splits_wavelengths() const { return plan_.photons_split_wavelengths; }
  // The path already has its new ray here.
  [[nodiscard]] float survival_weight(LightPath& path, const SurfaceVertex& vertex, const BsdfSample& event) {
    path.extend_branch(vertex.hit.shape, event);
    if (probe_opening_ && (event.delta || owns_scattered(path))) record_probe_hit(path, path.depth + 1);
    return event_throughput(event);
  }
  [[nodiscard]] float survival_weight_in_medium(LightPath& path) {
    path.scattered = true;
    if (probe_opening_ && owns_scattered(path)) record_probe_hit(path, path.depth + 1);
    return 1;
  }
  void resolve_connections();

 private:
  struct Connection {
    std::uint32_t path;
    int depth;
    SampledSpectrum contribution;  // without the transmittance of `ThroughMedia`
    FilmPoint at;
    std::uint32_t branch;
  };
  // Segment of a connection whose media are evaluated if the shadow ray is unoccluded.
  struct ThroughMedia {
    Ray ray;
    MediumState media;
    float distance;
  };

  [[nodiscard]] bool owns(const LightPath& path) const { return path.depth > 0 || sole_technique_; }
  // True if photons also own the light that the last vertex scatters to a probe.
  [[nodiscard]] bool owns_scattered(const LightPath& path) const {
    return sole_technique_ || scene_.lights[starts_[path.index].light].is_delta();
  }
  [[nodiscard]] std::optional<CameraConnection> probe_connection(const LightPath& path) const;
  // Records the path if its current ray, at the given depth, hits the probe.
  void record_probe_hit(const LightPath& path, int depth);
  void connect_to(const LightPath& path, int depth, const CameraConnection& lens,
                  const SampledSpectrum& scattered, const Ray& ray, const MediumState& media,
                  const std::optional<StokesSpectrum>& measured);
  [[nodiscard]] StokesSpectrum measured_stokes(const LightPath& path,
                                               const std::optional<MuellerMatrix>& matrix,
                                               const Imath::V3f& towards, const CameraConnection& lens) const;
  template <typename Contribution>
  void expose(const Connection& connection, Contribution contribution);

  const Plan& plan_;
  const Scene& scene_;
  RayCaster& caster_;
  float scale_;
  bool sole_technique_;  // no other technique is in the plan
  std::optional<Opening> probe_opening_;
  std::optional<Ball> ball_;
  FilmResponse response_;
  bool measures_polarisation_;
  PathBatch<LightTracer> batch_;
  const Deposit* deposit_ = nullptr;
  std::vector<PhotonStart> starts_;
  std::vector<Connection> connections_;          // connections of the current step
  std::vector<StokesSpectrum> measured_stokes_;  // measured polarisation of each, if carried
  std::vector<WavelengthImages>
      images_;  // film position per wavelength of each, for lenses that disperse them
  std::vector<ThroughMedia> through_media_;    // segments through media, if free paths exist
  std::vector<BasicRay<double>> shadow_rays_;  // shadow rays to the lens
  std::vector<std::uint8_t> occluded_;         // 1 if occluded
};

}  // namespace abbe
