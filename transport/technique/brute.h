#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "transport/path/film_response.h"
#include "transport/path/found_light.h"
#include "transport/path/path_recorder.h"
#include "transport/path/random_walk.h"
#include "transport/plan/plan.h"
#include "transport/technique/path.h"

namespace abbe {

/// What both kinds of brute force have in common [Marschner2021, ch. 14]: paths of one wavelength each,
/// that are never connected to anything, and whose events leave them what they set out with or end them by
/// chance.
template <TransportMode mode>
class BruteWalk {
 public:
  using Path = RecordedPath;
  static constexpr TransportMode kMode = mode;

  /// Leaves a packet its hero alone.
  static void keep_hero(PathPacket& packet);

  // What RandomWalks asks.
  void reach(RecordedPath& /*path*/, const SurfaceVertex& /*vertex*/) {}
  void connect(RecordedPath& /*path*/, const SurfaceVertex& /*vertex*/, const std::array<float, 4>& /*u*/) {}
  void connect_within(RecordedPath& /*path*/, const PhaseFunction& /*phase*/,
                      const std::array<float, 4>& /*u*/) {}
  [[nodiscard]] std::optional<BsdfSample> scatter(RecordedPath& path, const SurfaceVertex& vertex,
                                                  const BsdfRandom& u) const;
  [[nodiscard]] bool follows(RecordedPath& /*path*/, const BsdfSample& /*event*/) const { return true; }
  [[nodiscard]] bool follows_within(const RecordedPath& /*path*/) const { return true; }
  [[nodiscard]] float carried(const RecordedPath& path) const { return path.carried(); }
  void resolve_connections() {}
};

/// Brute-force photons: from the lights, of one wavelength each, to where they come in through the opening of
/// the camera, or onto its meter, by themselves. Serves one thread.
///
/// Owned: everything but what a camera without an opening sees, and what a beam or a point sends a meter that
/// is a point.
class BrutePhotonTracer : public BruteWalk<TransportMode::power> {
 public:
  /// `share` is the part of a sample per pixel one photon stands for.
  BrutePhotonTracer(const Plan& plan, RayCaster& caster, double share);

  /// Lets the tracer, from now on, also tell each contribution by itself, whose sum it deposits.
  void tell_apart(ContributionDeposit deposit) { apart_ = std::move(deposit); }

  /// Traces a photon for each of the samplers, and deposits those that the camera sees by their numbers.
  void trace(std::span<const Sampler> photons, const Deposit& deposit);

  // What RandomWalks asks besides.
  void escape(RecordedPath& /*path*/) {}
  void meet(RecordedPath& /*path*/, const SurfaceHit& /*hit*/) {}
  [[nodiscard]] float kept(RecordedPath& path, const SurfaceVertex& /*vertex*/, const BsdfSample& /*event*/) {
    return look_for_camera(path, path.events + 1), 1.0F;
  }
  [[nodiscard]] float kept_within(RecordedPath& path) { return look_for_camera(path, path.events + 1), 1.0F; }

 private:
  // By the ray that the path goes on along after so many events.
  void look_for_camera(const RecordedPath& path, int events);

  const Plan& plan_;
  const Scene& scene_;
  RayCaster& caster_;
  std::optional<Opening> opening_;
  float scale_;
  bool measures_polarisation_;
  FilmResponse response_;
  RandomWalks<BrutePhotonTracer> walks_;
  const Deposit* deposit_ = nullptr;
  ContributionDeposit apart_;  // if it is told
};

/// Brute-force adjoint photons, which run the other way in time: from the pixels, of one wavelength each, to
/// where they meet lights by themselves. Serves one thread.
///
/// Owned: everything that ends on a light with area.
class AdjointBruteTracer : public BruteWalk<TransportMode::radiance> {
 public:
  AdjointBruteTracer(const Plan& plan, RayCaster& caster);

  /// Lets the tracer, from now on, also tell each contribution by itself, whose sum it deposits.
  void tell_apart(ContributionDeposit deposit) { apart_ = std::move(deposit); }

  /// Traces a path for each of some samples, and deposits what they find by their numbers.
  void trace(std::span<const PixelSample> samples, const Deposit& deposit);

  // What RandomWalks asks besides.
  void escape(RecordedPath& path);
  void meet(RecordedPath& path, const SurfaceHit& hit);
  [[nodiscard]] float kept(RecordedPath& /*path*/, const SurfaceVertex& /*vertex*/,
                           const BsdfSample& /*event*/) const {
    return 1;
  }
  [[nodiscard]] float kept_within(const RecordedPath& /*path*/) const { return 1; }

 private:
  void add_met(const RecordedPath& path, std::uint32_t light);
  template <typename Contribution, typename DepositAt>
  void expose(const RecordedPath& path, const Contribution& contribution, DepositAt deposit);

  const Plan& plan_;
  const Scene& scene_;
  FilmResponse response_;
  RandomWalks<AdjointBruteTracer> walks_;
  std::vector<FilmPoint> at_;       // where each path exposes the film,
  std::vector<LaneImages> images_;  // and its lanes, behind a lens that displaces them,
  FoundLight found_;                // and with what
  ContributionDeposit apart_;       // if it is told
};

}  // namespace abbe
