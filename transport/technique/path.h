#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sampling/sampler.h"
#include "scene/camera/camera.h"
#include "transport/path/film_response.h"
#include "transport/path/mis_weight.h"
#include "transport/path/path_batch.h"
#include "transport/path/path_vertex.h"
#include "transport/path/ray_caster.h"
#include "transport/path/vertex.h"
#include "transport/plan/plan.h"
#include "transport/technique/ghost_lights.h"

namespace abbe {

/// Last scattering of a path at a surface where the caustic guide has lobes: the arguments of the pdf with
/// which the guide samples the same direction.
struct GuidedScattering {
  CausticLobes lobes;
  Imath::V3f point{0, 0, 0};      ///< Point of the surface in world space.
  Imath::V3f direction{0, 0, 1};  ///< Unit direction in world space in which the path left.
  SampledSpectrum pdf;            ///< BSDF sampling pdf per wavelength [1/sr].
};

/// Path from the camera.
struct CameraPath : PathState {
  using PathState::PathState;
  FilmPoint at;              ///< Film point to which the path contributes.
  SampledSpectrum scale;     ///< Exposure of the film per radiance along the first ray [sr s].
  SampledSpectrum radiance;  ///< Weighted sum of its contributions so far.
  /// Factor that undoes the reduction of the throughput by refraction, guiding and a dispersing lens; for
  /// roulette.
  float eta_scale = 1;
  bool is_split_child = false;            ///< True after the path has split by `Plan::log2_splits`.
  float rr_scale = kCameraRouletteScale;  ///< Factor from throughput to the throughput that roulette uses.
  bool owns_caustics = false;  ///< True if the path owns traced lights that it hits by specular events.
  CausticLobes caustics;       ///< Lobes of the caustic guide at the current vertex.
  GuidedScattering guided;  ///< Its lobes are empty if the guide could not have sampled the last direction.
  bool seeks_caustic = false;  ///< True if the guide sampled its direction: only specular events continue it.
  LensRoute route = 0;         ///< Route of the path through the lens; above 0 for a ghost.

  /// Throughput without the loss of radiance by refraction into glass.
  [[nodiscard]] float roulette_throughput() const { return packet.throughput_estimate() * eta_scale; }
  /// `roulette_throughput`, but 0 for a path sampled from the guide, because BSDF sampling finds the same
  /// light.
  [[nodiscard]] float throughput_estimate() const { return seeks_caustic ? 0 : roulette_throughput(); }
};

/// Sample of a pixel.
struct PixelSample {
  int x;            ///< Column of the pixel.
  int y;            ///< Row of the pixel.
  Sampler sampler;  ///< Random numbers of the path.
};

/// Unidirectional path tracer [Kajiya1986] with next-event estimation at every non-specular vertex and
/// Russian roulette. MIS: balance heuristic over wavelengths and over {BSDF sampling, NEE}; `PathSampling`
/// selects other combinations.
///
/// If the plan's guide has caustics that no other technique owns, a second path may leave a surface in a
/// direction of the guide. It ends at the first non-specular event, and its emitter hits are balanced with
/// those of BSDF sampling. The plan may split paths at the first scattering surface [Arvo1990]. One instance
/// per thread.
///
/// Path classes owned: every path that ends on an area, environment or sun light, or by NEE. Exception: paths
/// to a traced light whose neighbouring vertex is specular. Of these, camera paths are owned only if their
/// first vertex is specular too, and probe paths only if their first vertex scatters. Deposited values are
/// those of one sample per pixel.
class PathTracer : public PathCallbacks<TransportMode::radiance>, public LayerSource {
 public:
  using Path = CameraPath;

  /// Plan and caster must outlive the tracer.
  PathTracer(const Plan& plan, RayCaster& caster);

  /// Traces a path for each sample and deposits each sum under its sample's index in `samples`, at least once
  /// per sample. Throws Error{resource} if more than `MediumStack::kMaxShapes` media nest.
  void trace(std::span<const PixelSample> samples, const Deposit& deposit);

  // Callbacks (`PathCallbacks`).
  void on_escape(CameraPath& path);
  void on_hit(CameraPath& path, const SurfaceHit& hit);
  void prepare_scatter(CameraPath& path, const SurfaceVertex& vertex) const;
  void connect(CameraPath& path, const SurfaceVertex& vertex, const std::array<float, 4>& u);
  void connect_in_medium(CameraPath& path, const PhaseFunction& phase, const std::array<float, 4>& u);
  // True if point and spot lights are also sampled along scattering segments.
  [[nodiscard]] bool connects_equiangular() const {
    return !plan_.equiangular_lights.empty() && weights_.connects();
  }
  void connect_equiangular(CameraPath& path, const MediumSegment& segment, const Imath::V2f& u);
  [[nodiscard]] std::optional<BsdfSample> scatter(CameraPath& path, const SurfaceVertex& vertex,
                                                  const BsdfRandom& u) const {
    if (restricts_acceptance_ && path.depth == kProbeDepth) return sample_probe_direction(u.direction);
    std::optional<BsdfSample> event = scatter_unguided(path, vertex, u);
    if (event && !event->delta) remember_guide(path, vertex, *event);
    return event;
  }
  [[nodiscard]] std::optional<float> adds_path(const CameraPath& path) const;
  [[nodiscard]] std::optional<BsdfSample> scatter_added(CameraPath& path, const SurfaceVertex& vertex) const;
  [[nodiscard]] bool continues_after(CameraPath& path, const BsdfSample& event) const;
  [[nodiscard]] bool continues_in_medium(CameraPath& path) const {
    if (path.depth == 0) path.owns_caustics = camera_.probe_acceptance.has_value();
    path.guided.lobes = {};
    return !path.seeks_caustic;
  }
  [[nodiscard]] float survival_weight(CameraPath& path, const SurfaceVertex& vertex,
                                      const BsdfSample& event) const;
  [[nodiscard]] float survival_weight_in_medium(const CameraPath& path) const {
    return path.rr_scale * path.roulette_throughput();
  }
  [[nodiscard]] bool reuses_spare_dimensions(const CameraPath& path) const { return !path.seeks_caustic; }
  // A path splits once, at a surface.
  [[nodiscard]] int log2_splits(const CameraPath& path) const {
    return path.is_split_child || path.seeks_caustic || path.depth == kProbeDepth ? 0 : plan_.log2_splits;
  }
  // Each child has 1/2^log2_count of the throughput. A survival scale of 2^log2_count would treat it as a
  // path of its own. But all children have a common prefix, whose noise their last events do not change. The
  // scale is therefore 2^(3/4 log2_count), between the square root and the whole.
  void on_split(CameraPath& child, int log2_count) const {
    child.is_split_child = true;
    child.rr_scale *= std::exp2(0.75F * static_cast<float>(log2_count));
  }
  void resolve_connections();

 private:
  // Light sampled for a point: its index, a direction to it unless it is invisible, and the joint pdf.
  struct ChosenLight {
    std::uint32_t index;
    const Light& light;
    std::optional<LightSample> towards;  // constructed in place: a copy would wait for the store
    float pdf;
  };
  struct Connection {
    std::uint32_t path;
    ContributionInfo info;
    SampledSpectrum contribution;  // unweighted and unattenuated if `ThroughMedia` follows
    float cos_film;
  };
  // Arguments of the weight of a connection whose media are evaluated if the shadow ray is unoccluded.
  struct ThroughMedia {
    Ray ray;
    MediumState media;
    SampledSpectrum scattering_pdf;  // per wavelength, times the path's lane pdf
    float light_pdf;
    float path_pdf;  // sum of the lane pdfs
    float distance;
  };

  void trace_batch(std::span<const PixelSample> samples);
  void start(std::span<const PixelSample> samples);
  void start_batch(std::span<const PixelSample> samples);
  [[nodiscard]] std::optional<BsdfSample> scatter_unguided(const CameraPath& path,
                                                           const SurfaceVertex& vertex,
                                                           const BsdfRandom& u) const {
    return directions_ == DirectionSampling::bsdf
               ? vertex.scatter(u, path.packet.hero, kMode)
               : sample_directions(directions_, vertex, u, path.packet.hero, kMode);
  }
  // Stores the arguments of the guide's pdf for this event's direction.
  void remember_guide(CameraPath& path, const SurfaceVertex& vertex, const BsdfSample& event) const {
    path.guided.lobes = path.caustics;
    if (path.caustics.empty()) return;
    path.guided.point = vertex.hit.point;
    path.guided.direction = vertex.frame.to_world(event.wi);
    path.guided.pdf = event.lane_pdf * event.pdf;
  }
  // Pdf [1/sr], per wavelength, with which `scatter_unguided` samples a local direction.
  [[nodiscard]] SampledSpectrum unguided_pdf(const SurfaceVertex& vertex, const Imath::V3f& wi) const {
    return directions_ == DirectionSampling::bsdf ? pdf(vertex.bsdf, vertex.wo, wi)
                                                  : pdf_of_directions(directions_, vertex, wi);
  }
  // Applies a probe's acceptance cone to a connection; returns false if the direction is outside.
  [[nodiscard]] bool apply_acceptance(const Imath::V3f& direction, const Imath::V3f& normal,
                                      SampledSpectrum& contribution, SampledSpectrum& pdf) const;
  [[nodiscard]] BsdfSample sample_probe_direction(const Imath::V2f& u) const;
  // Draws the packet of a path and the arguments of its camera ray.
  [[nodiscard]] CameraSample draw_camera_sample(const PixelSample& sample, CameraPath& path) const;
  // Starts a path; returns false if it ends at the lens or probe.
  bool start(const PixelSample& sample, const CameraRay& ray, CameraPath& path);
  bool displace_wavelengths(const CameraRay& ray, CameraPath& path);
  // True if paths use next-event estimation.
  [[nodiscard]] bool connects() const { return weights_.connects() && !plan_.path_lights.empty(); }
  [[nodiscard]] ChosenLight choose_light(const LightSampleContext& context, const std::array<float, 4>& u,
                                         float time) const;
  [[nodiscard]] float equiangular_pdf(const MediumSegment& segment, float distance,
                                      std::uint32_t light) const;
  [[nodiscard]] float nee_pdf(const CameraPath& path, const LightVertex& emitter_hit) const;
  [[nodiscard]] static StokesSpectrum measure(const CameraPath& path,
                                              const std::optional<MuellerMatrix>& matrix, const Light& light,
                                              const Imath::V3f& wi);
  [[nodiscard]] bool is_owned_by_other(const CameraPath& path, std::uint32_t light) const;
  void connect_through_media(const CameraPath& path, const ChosenLight& chosen,
                             const SampledSpectrum& contribution, const SampledSpectrum& scattering_pdf,
                             const Ray& ray, const MediumState& media, float cos_film,
                             const std::optional<StokesSpectrum>& measured);
  bool apply_transmittance(Connection& connection, const ThroughMedia& segment);
  void add_emission(CameraPath& path, const LightVertex& emitter_hit);
  [[nodiscard]] SampledSpectrum pdf_with_guide(const CameraPath& path) const;
  void add(CameraPath& path, const ContributionInfo& info, const SampledSpectrum& contribution,
           float cos_film, const StokesSpectrum* measured);
  template <typename Contribution>
  void add_to(Contribution& radiance, CameraPath& path, const ContributionInfo& info,
              const Contribution& contribution, float cos_film);
  void expose(const CameraPath& path);
  template <typename Contribution>
  void expose(const CameraPath& path, const Contribution& radiance);

  const Plan& plan_;
  const Scene& scene_;
  CameraTraits camera_;
  RayCaster& caster_;
  FilmResponse response_;
  DirectionSampling directions_;
  LightWeights weights_;
  bool carries_polarisation_;
  bool measures_polarisation_;
  bool restricts_acceptance_;  // the camera is a probe with an acceptance below a hemisphere
  PathBatch<PathTracer> batch_;
  GhostLights ghosts_;
  const Deposit* deposit_ = nullptr;
  std::uint32_t first_ = 0;                   // index of the first path of the batch
  std::vector<CameraSample> camera_samples_;  // camera samples, for lenses that disperse wavelengths
  std::vector<CameraRay> rays_;               // their camera rays
  std::vector<WavelengthImages> images_;      // their film positions per wavelength
  std::vector<StokesSpectrum> stokes_;        // sums of each path, if the sensor distinguishes polarisation
  std::vector<Connection> connections_;       // connections of the current step
  std::vector<StokesSpectrum> measured_stokes_;  // measured polarisation of each, if carried
  std::vector<ThroughMedia> through_media_;      // segments through media, if free paths exist
  std::vector<BasicRay<double>> shadow_rays_;    // shadow rays to the lights
  std::vector<std::uint8_t> occluded_;           // 1 if occluded
};

}  // namespace abbe
