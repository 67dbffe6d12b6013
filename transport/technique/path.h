#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "sampling/sampler.h"
#include "scene/camera/camera_rays.h"
#include "transport/path/film_response.h"
#include "transport/path/met_lights.h"
#include "transport/path/mis_weight.h"
#include "transport/path/random_walk.h"
#include "transport/path/ray_caster.h"
#include "transport/path/surface_directions.h"
#include "transport/plan/plan.h"
#include "transport/technique/ghost_lights.h"

namespace abbe {

/// The last scattering of a path at a surface where the caustic guide has lobes: the arguments of the density
/// with which the guide draws the same direction.
struct GuidedScattering {
  CausticLobes lobes;
  Imath::V3f point{0, 0, 0};
  Imath::V3f direction{0, 0, 1};
  SampledSpectrum pdf;  ///< Density of scattering, per wavelength [1/sr].
};

/// A path from the camera, under way.
struct CameraPath : Walk {
  using Walk::Walk;
  FilmPoint at;
  SampledSpectrum scale;  ///< What radiance along its first ray exposes, times the exposure time.
  SampledSpectrum found;  ///< Light it has found so far, balanced over lanes and techniques.
  float eta_scale = 1;    ///< What refraction, guiding and the lens's parting of lanes have taken off it.
  bool is_part = false;   ///< Of a path that has gone on in several.
  float going_on = kGoingOnOfCameraPaths;  ///< What roulette goes by, over what it carries.
  bool owns_caustics = false;  ///< Whether what it finds of traced lights through specular matter is its own.
  CausticLobes caustics;       ///< Where to look for them from the vertex it has come to.
  GuidedScattering guided;     ///< Its lobes are empty if the guide could not have drawn the last scattering.
  bool seeks_caustic = false;  ///< True if its direction is from the guide: only specular events continue it.
  LensRoute route = 0;         ///< By which it left the film.
};

/// One sample of a pixel.
struct PixelSample {
  int x;
  int y;
  Sampler sampler;
  double weight = 1;  ///< By which what it exposes counts, as not all pixels have a path in each sample.
};

/// Path tracing [Kajiya1986]: from the camera, with a connection to a light at every vertex that is not
/// specular, balanced over lanes and over both ways to come to the light, and Russian roulette; directions
/// and weights are others where the scene's PathSampling asks. Where the plan's guide knows of caustics that
/// no other technique owns, a second path may leave a surface in a direction of the guide. It ends at the
/// first event that is not specular, and the light that it meets is balanced with what scattering finds.
/// Where the plan says so, a path goes on in several from the first surface that scatters it [Arvo1990].
/// Serves one thread.
///
/// Owned: every path that ends on an area, environment or sun light or by a connection. Of a traced light
/// whose vertex next to it is specular, a camera's only if the vertex next to it is specular too, and a
/// meter's only if that scatters.
class PathTracer {
 public:
  using Path = CameraPath;
  static constexpr TransportMode kMode = TransportMode::radiance;

  PathTracer(const Plan& plan, RayCaster& caster);

  /// Lets the tracer, from now on, also tell each contribution by itself, whose sum it deposits.
  void tell_apart(ContributionDeposit deposit) { apart_ = std::move(deposit); }

  /// Traces a path for each of some samples, and deposits what they find by their numbers, at least once
  /// each.
  void trace(std::span<const PixelSample> samples, const Deposit& deposit);

  // What RandomWalks asks.
  void escape(CameraPath& path);
  void meet(CameraPath& path, const SurfaceHit& hit);
  void reach(CameraPath& path, const SurfaceVertex& vertex) const;
  void connect(CameraPath& path, const SurfaceVertex& vertex, const std::array<float, 4>& u);
  void connect_within(CameraPath& path, const PhaseFunction& phase, const std::array<float, 4>& u);
  // Lamps at points are connected to from places along stretches of matter too, where they are near.
  [[nodiscard]] bool connects_along() const { return !plan_.lights_along.empty() && weights_.connects(); }
  void connect_along(CameraPath& path, const Stretch& stretch, const Imath::V2f& u);
  [[nodiscard]] std::optional<BsdfSample> scatter(CameraPath& path, const SurfaceVertex& vertex,
                                                  const BsdfRandom& u) const {
    if (narrow_ && path.events == kMeterEvent) return leave_meter(u.direction);
    std::optional<BsdfSample> event = scatter_unguided(path, vertex, u);
    if (event && !event->delta) remember_guide(path, vertex, *event);
    return event;
  }
  [[nodiscard]] std::optional<float> adds_path(const CameraPath& path) const;
  [[nodiscard]] std::optional<BsdfSample> scatter_added(CameraPath& path, const SurfaceVertex& vertex) const;
  [[nodiscard]] bool follows(CameraPath& path, const BsdfSample& event) const;
  [[nodiscard]] bool follows_within(CameraPath& path) const {
    if (path.events == 0) path.owns_caustics = camera_.meter_acceptance.has_value();
    path.guided.lobes = {};
    return !path.seeks_caustic;
  }
  [[nodiscard]] float kept(CameraPath& path, const SurfaceVertex& vertex, const BsdfSample& event) const;
  [[nodiscard]] float kept_within(const CameraPath& path) const {
    return path.going_on * roulette_throughput(path);
  }
  [[nodiscard]] bool joins_directions(const CameraPath& path) const { return !path.seeks_caustic; }
  // Once, at a surface.
  [[nodiscard]] int split_bits(const CameraPath& path) const {
    return path.is_part || path.seeks_caustic || path.events == kMeterEvent ? 0 : plan_.split_bits;
  }
  // Each carries 1/2^bits of the path. It goes on as a path of its own would, but for what all parts have in
  // common, whose noise the last of their events do not change: between the root of 2^bits times what it
  // carries and all 2^bits times.
  void split(CameraPath& part, int bits) const {
    part.is_part = true;
    part.going_on *= std::exp2(0.75F * static_cast<float>(bits));
  }
  // A path drawn from the guide is counted nowhere when it is cut: scattering finds the same light.
  [[nodiscard]] float carried(const CameraPath& path) const {
    return path.seeks_caustic ? 0 : roulette_throughput(path);
  }
  void resolve_connections();

 private:
  // Throughput without the loss of radiance by refraction into glass.
  [[nodiscard]] static float roulette_throughput(const CameraPath& path) {
    return path.packet.carried() * path.eta_scale;
  }
  // A light, a direction towards it from a point, if it can reach that, and the density of both.
  struct ChosenLight {
    std::uint32_t index;
    const Light& light;
    std::optional<LightSample> towards;  // where it was made: copying what was just stored waits for memory
    float pdf;
  };
  struct Connection {
    std::uint32_t path;
    LightHistory of;
    SampledSpectrum contribution;  // where matter lies between, what sets out, not weighed
    float cos_film;
  };
  // What a connection whose matter is followed once nothing is known to block it is weighed by.
  struct ThroughMatter {
    Ray ray;
    Surroundings around;
    SampledSpectrum scattering_pdf;  // of each lane, times that of the path
    float light_pdf;
    float path_pdf;  // the sum over lanes
    float distance;
  };

  void trace_together(std::span<const PixelSample> samples);
  void start(std::span<const PixelSample> samples);
  void start_together(std::span<const PixelSample> samples);
  [[nodiscard]] std::optional<BsdfSample> scatter_unguided(const CameraPath& path,
                                                           const SurfaceVertex& vertex,
                                                           const BsdfRandom& u) const {
    return directions_ == DirectionSampling::bsdf
               ? vertex.scatter(u, path.packet.hero, kMode)
               : sample_directions(directions_, vertex, u, path.packet.hero, kMode);
  }
  // Stores the arguments of the guide's density for the direction of this event.
  void remember_guide(CameraPath& path, const SurfaceVertex& vertex, const BsdfSample& event) const {
    path.guided.lobes = path.caustics;
    if (path.caustics.empty()) return;
    path.guided.point = vertex.hit.point;
    path.guided.direction = vertex.frame.to_world(event.wi);
    path.guided.pdf = event.lane_pdf * event.pdf;
  }
  // With which `scatter_unguided` draws a local direction, were each lane the hero [1/sr].
  [[nodiscard]] SampledSpectrum unguided_pdf(const SurfaceVertex& vertex, const Imath::V3f& wi) const {
    return directions_ == DirectionSampling::bsdf ? pdf(vertex.bsdf, vertex.wo, wi)
                                                  : pdf_of_directions(directions_, vertex, wi);
  }
  // Whether a meter counts light from there; then what stands for it.
  [[nodiscard]] bool accepted(const Imath::V3f& direction, const Imath::V3f& normal,
                              SampledSpectrum& contribution, SampledSpectrum& pdf) const;
  [[nodiscard]] BsdfSample leave_meter(const Imath::V2f& u) const;
  // Draws the wavelengths of a path, and tells by what its ray is asked for.
  [[nodiscard]] CameraSample ask(const PixelSample& sample, CameraPath& path) const;
  // Whether there is more to find than what a meter sees directly.
  bool start(const PixelSample& sample, const CameraRay& ray, CameraPath& path);
  bool part_lanes(const CameraRay& ray, CameraPath& path);
  // Whether paths are connected to lights that are chosen for their places.
  [[nodiscard]] bool connects() const { return weights_.connects() && !plan_.path_lights.empty(); }
  [[nodiscard]] ChosenLight choose_light(const LightSampleContext& place, const std::array<float, 4>& u,
                                         float time) const;
  [[nodiscard]] float pdf_along(const Stretch& stretch, float distance, std::uint32_t light) const;
  [[nodiscard]] float connection_pdf(const CameraPath& path, const LightVertex& met) const;
  [[nodiscard]] static StokesSpectrum measured(const CameraPath& path,
                                               const std::optional<MuellerMatrix>& matrix, const Light& light,
                                               const Imath::V3f& wi);
  [[nodiscard]] bool owned_by_others(const CameraPath& path, std::uint32_t light) const;
  void connect_through_matter(const CameraPath& path, const ChosenLight& chosen,
                              const SampledSpectrum& contribution, const SampledSpectrum& scattering_pdf,
                              const Ray& ray, const Surroundings& around, float cos_film,
                              const std::optional<StokesSpectrum>& seen);
  bool pass_matter(Connection& connection, const ThroughMatter& way);
  void add_met(CameraPath& path, const LightVertex& met);
  [[nodiscard]] SampledSpectrum pdf_with_guide(const CameraPath& path) const;
  void add(CameraPath& path, const LightHistory& of, const SampledSpectrum& contribution, float cos_film,
           const StokesSpectrum* seen);
  template <typename Contribution>
  void add_to(Contribution& found, CameraPath& path, const LightHistory& of, const Contribution& contribution,
              float cos_film);
  void expose(const CameraPath& path);
  template <typename Contribution>
  void expose(const CameraPath& path, const Contribution& found);

  const Plan& plan_;
  const Scene& scene_;
  CameraTraits camera_;
  RayCaster& caster_;
  FilmResponse response_;
  DirectionSampling directions_;
  LightWeights weights_;
  bool carries_polarisation_;
  bool measures_polarisation_;
  bool narrow_;  // a meter that does not count all of its hemisphere
  RandomWalks<PathTracer> walks_;
  GhostLights ghosts_;
  const Deposit* deposit_ = nullptr;
  std::uint32_t first_ = 0;              // number of the first of the paths under way
  std::vector<CameraSample> asked_;      // of each, behind a lens that displaces lanes,
  std::vector<CameraRay> rays_;          // the ray that it leaves the film by,
  std::vector<LaneImages> images_;       // and where its lanes fall
  ContributionDeposit apart_;            // if it is told
  std::vector<StokesSpectrum> found_;    // by each, where the sensor tells how light is polarised
  std::vector<Connection> connections_;  // of the step under way,
  std::vector<StokesSpectrum>
      seen_;  // what the sensor measures of their light, where polarisation is carried,
  std::vector<ThroughMatter> through_;  // what they come through, where any matter has to be followed,
  std::vector<BasicRay<double>> ways_;  // their ways to the light,
  std::vector<std::uint8_t> blocked_;   // and whether something stands on them
};

}  // namespace abbe
