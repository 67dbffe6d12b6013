#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "sampling/sampler.h"
#include "transport/path/film_response.h"
#include "transport/path/found_light.h"
#include "transport/path/joined_vertices.h"
#include "transport/path/path_recorder.h"
#include "transport/path/strategies.h"
#include "transport/plan/plan.h"
#include "transport/technique/ghost_lights.h"
#include "transport/technique/light_paths.h"

namespace abbe {

/// One sample of a pixel, with a path from a light beside that from the camera.
struct PixelPair {
  int x;
  int y;
  Sampler camera;
  Sampler light;
  bool seen;  ///< Whether the pixel itself is asked for; if not, its light's path exposes others alone.
};

/// Bidirectional path tracing [Lafortune1993] [Veach1997, ch. 10]: a path from the camera and one from a
/// light, of the same wavelengths and hero, are joined at their vertices, many of those of long paths left
/// out (`choose_joined`), and what they carry is balanced over all strategies and lanes. With the paths from
/// lights of a whole sample, a vertex of the camera's path is also merged with those of any of them close by,
/// a strategy beside the others: vertex connection and merging [Georgiev2012] [Hachisuka2012]. Serves one
/// thread.
///
/// Owned: every path that ends on a light with area, and of those that end on another one all that have two
/// neighbouring vertices, the light's own included, where light does not go in a single direction. By
/// merging, which blurs, all that has one such vertex at a surface.
class BidirectionalTracer {
 public:
  BidirectionalTracer(const Plan& plan, RayCaster& caster);

  /// Lets the tracer, from now on, also tell each contribution by itself, whose sum it deposits.
  void tell_apart(ContributionDeposit deposit) { apart_ = std::move(deposit); }

  /// Traces both paths of each of some samples, and deposits what they find by their numbers.
  void trace(std::span<const PixelPair> samples, const Deposit& deposit);

  /// The same with paths from lights that have been traced, of which the samples' own are connected and all
  /// are merged with; the samples' `light` is not asked.
  void trace(std::span<const PixelPair> samples, const LightPaths& from_lights, const Deposit& deposit);

 private:
  void trace_together(std::span<const PixelPair> samples, std::uint32_t first);
  void join(std::uint32_t i);
  void join(std::uint32_t i, const JoinedVertex& x);
  void meet(std::uint32_t i, const MetLight& met);
  void connect_to_light(std::uint32_t i, std::size_t t);
  void connect(std::uint32_t i, std::size_t t, std::size_t s);
  void connect_to_lens(std::uint32_t i, std::size_t s);
  void merge(std::uint32_t i, std::size_t t);
  void merge(std::uint32_t i, std::size_t t, const LightPaths::Vertex& at);
  [[nodiscard]] LightPaths::Path own_light_path(std::uint32_t i);
  void set_joined(std::uint32_t i, std::size_t t, const LightPaths::Path& photon, std::size_t s);
  void add_joined(std::uint32_t i, const FilmPoint& at);
  [[nodiscard]] float weight();
  [[nodiscard]] float by_path_tracing() const;
  [[nodiscard]] FilmPoint film_point(std::uint32_t i, std::size_t t, const PathVertex& b);
  void add(std::uint32_t i, const FilmPoint& at, std::uint32_t light, const SampledSpectrum& contribution,
           const std::optional<StokesSpectrum>& seen);
  template <typename Contribution>
  void expose(std::uint32_t i, const FilmPoint& at, const Contribution& contribution);
  template <typename Contribution, typename DepositAt>
  void expose(std::uint32_t i, const FilmPoint& at, const Contribution& contribution, DepositAt deposit);

  const Plan& plan_;
  const Scene& scene_;
  RayCaster& caster_;
  bool meter_;  // instead of a lens
  std::size_t most_vertices_;
  FilmResponse response_;
  PathRecorder<TransportMode::radiance> from_camera_;
  PathRecorder<TransportMode::power> from_light_;
  GhostLights ghosts_;
  const LightPaths* from_lights_ = nullptr;  // if they are given
  const Deposit* deposit_ = nullptr;
  ContributionDeposit apart_;           // if it is told
  std::span<const PixelPair> samples_;  // under way
  std::uint32_t first_ = 0;             // number of the first of the samples under way
  std::vector<FilmPoint> at_;           // where each exposes the film,
  std::vector<LaneImages> images_;      // and its lanes, behind a lens that displaces them,
  FoundLight found_;                    // and with what
  StrategyWeights weights_;
  JoinedPath joined_;
  float count_ = 1;                      // how often it counts
  std::vector<JoinedVertex> of_camera_;  // of the paths in hand, which are joined
  std::vector<JoinedVertex> of_light_;
  std::vector<LightPaths::Vertex> near_;  // at one place
};

}  // namespace abbe
