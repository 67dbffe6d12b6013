#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "sampling/sampler.h"
#include "transport/path/film_response.h"
#include "transport/path/random_walk.h"
#include "transport/path/ray_caster.h"
#include "transport/plan/plan.h"
#include "transport/technique/photon_start.h"

namespace abbe {

/// A path from a light, under way: a photon.
struct LightPath : Walk {
  using Walk::Walk;
  float power = 0;  ///< That it set out with, its largest lane's.
  /// Hash of the specular events before the first event of another kind, and of their shapes.
  std::uint32_t branch = 0;
  bool scattered = false;  ///< True after an event that is not specular: the branch is complete.
  /// Adds an event to the branch by a step of the FNV-1a hash.
  void extend_branch(std::uint32_t shape, const BsdfSample& event) {
    constexpr std::uint32_t kPrime = 16777619;
    scattered = scattered || !event.delta;
    if (!scattered) branch = (branch ^ (2 * shape + (event.transmitted ? 2U : 1U))) * kPrime;
  }
};

/// Light tracing [Arvo1986]: from the lights that need it, with a connection to the camera at every vertex
/// that is not specular. A photon whose first vertex is not specular is not followed, as path tracing owns
/// it, unless no other technique is in the plan. A meter is exposed where photons run into it: by all of
/// them, or beside path tracing by those whose last vertex is specular and all of lights without area. Where
/// the plan says so photons part into their lanes in dispersive glass. Serves one thread.
class LightTracer {
 public:
  using Path = LightPath;
  static constexpr TransportMode kMode = TransportMode::power;

  /// `share` is the part of a sample per pixel one photon stands for: 1/pixels when a sample per pixel is as
  /// many photons as pixels. With a `ball_radius` [m] a meter's first pixel is exposed by whatever comes
  /// into, or starts within, the ball of that radius around its middle, which tells what passes near the
  /// meter.
  LightTracer(const Plan& plan, RayCaster& caster, double share, std::optional<double> ball_radius = {});

  /// Lets the tracer, from now on, also tell by which way the light of each deposit came.
  void tell_apart(ContributionDeposit deposit) { apart_ = std::move(deposit); }

  /// Traces a photon for each of the samplers, and deposits what its connections bring, by its number.
  void trace(std::span<const Sampler> photons, const Deposit& deposit);
  /// Tells how the photons of the last call set out.
  [[nodiscard]] std::span<const PhotonStart> starts() const { return starts_; }

  // What RandomWalks asks.
  void escape(LightPath& /*path*/) {}
  void meet(LightPath& /*path*/, const SurfaceHit& /*hit*/) {}
  void reach(LightPath& /*path*/, const SurfaceVertex& /*vertex*/) {}
  void connect(LightPath& path, const SurfaceVertex& vertex, const std::array<float, 4>& u);
  void connect_within(LightPath& path, const PhaseFunction& phase, const std::array<float, 4>& u);
  [[nodiscard]] std::optional<BsdfSample> scatter(const LightPath& path, const SurfaceVertex& vertex,
                                                  const BsdfRandom& u) const {
    return vertex.scatter(u, path.packet.hero, kMode);
  }
  // Whether paths that scatter at their first vertex in more than a single direction go on.
  [[nodiscard]] bool follows(const LightPath& path, const BsdfSample& event) const {
    return event.delta || owned(path);
  }
  [[nodiscard]] bool follows_within(const LightPath& path) const { return owned(path); }
  // Whether the lanes of a photon go on by themselves where glass disperses them.
  [[nodiscard]] bool parts_lanes() const { return plan_.photons_part; }
  // The power a photon starts with says nothing about what it adds to the film: roulette goes by what the
  // event itself keeps. Its ray has left by then.
  [[nodiscard]] float kept(LightPath& path, const SurfaceVertex& vertex, const BsdfSample& event) {
    path.extend_branch(vertex.hit.shape, event);
    if (meter_ && (event.delta || owns_scattered(path))) run_into_meter(path, path.events + 1);
    return kept_by(event);
  }
  [[nodiscard]] float kept_within(LightPath& path) {
    path.scattered = true;
    if (meter_ && owns_scattered(path)) run_into_meter(path, path.events + 1);
    return 1;
  }
  [[nodiscard]] float carried(const LightPath& path) const { return path.packet.carried() / path.power; }
  void resolve_connections();

 private:
  struct Connection {
    std::uint32_t path;
    int events;
    SampledSpectrum contribution;  // but for what `ThroughMatter` takes
    FilmPoint at;
    std::uint32_t branch;
  };
  // The way of a connection whose matter is followed once nothing is known to block it.
  struct ThroughMatter {
    Ray ray;
    Surroundings around;
    float distance;
  };

  [[nodiscard]] bool owned(const LightPath& path) const { return path.events > 0 || alone_; }
  // Whether also what scattering sends a meter is for photons alone.
  [[nodiscard]] bool owns_scattered(const LightPath& path) const {
    return alone_ || scene_.lights[starts_[path.path].light].is_delta();
  }
  [[nodiscard]] std::optional<CameraConnection> into_meter(const LightPath& path) const;
  // By the ray that the path goes on along after so many events.
  void run_into_meter(const LightPath& path, int events);
  void connect_to(const LightPath& path, int events, const CameraConnection& lens,
                  const SampledSpectrum& scattered, const Ray& ray, const Surroundings& around,
                  const std::optional<StokesSpectrum>& arrives);
  [[nodiscard]] StokesSpectrum arriving(const LightPath& path, const std::optional<MuellerMatrix>& matrix,
                                        const Imath::V3f& towards, const CameraConnection& lens) const;
  template <typename Contribution>
  void expose(const Connection& found, Contribution contribution);

  const Plan& plan_;
  const Scene& scene_;
  RayCaster& caster_;
  float scale_;
  bool alone_;  // owns all that photons bring
  std::optional<Opening> meter_;
  std::optional<Sphere> ball_;
  FilmResponse response_;
  bool measures_polarisation_;
  RandomWalks<LightTracer> walks_;
  const Deposit* deposit_ = nullptr;
  ContributionDeposit apart_;  // if it is told
  std::vector<PhotonStart> starts_;
  std::vector<Connection> connections_;  // of the step under way,
  std::vector<StokesSpectrum> arrives_;  // how their light is polarised, where that is carried,
  std::vector<LaneImages> images_;       // where their lanes fall, behind a lens that displaces these,
  std::vector<ThroughMatter> through_;   // what they come through, where any matter has to be followed,
  std::vector<BasicRay<double>> ways_;   // their ways to the lens,
  std::vector<std::uint8_t> blocked_;    // and whether something stands on them
};

}  // namespace abbe
