#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sampling/sampler.h"
#include "transport/path/connect.h"
#include "transport/path/film_response.h"
#include "transport/path/mis_weight.h"
#include "transport/path/path_recorder.h"
#include "transport/plan/plan.h"
#include "transport/technique/ghost_lights.h"
#include "transport/technique/photon_map.h"

namespace abbe {

/// Light subpaths of a sample, all with one packet, for connection to any camera subpath of the sample. Only
/// vertices and samplers are stored, in batches of `kBatchSize`. The next sample reuses the memory. The order
/// of calls is `begin`, `store` for every batch, `finish`, and then the queries, which may run concurrently.
class LightSubpaths {
 public:
  /// Completed subpath.
  struct Path {
    /// The first vertex is on the light; empty if no light was emitted. Valid until the next `store`.
    std::span<const PathVertex> vertices;
    Sampler sampler;  ///< Random numbers of the subpath.
  };
  /// Vertex on a scattering surface, to be queried by position.
  struct Vertex {
    std::uint32_t path;    ///< Index of the subpath.
    std::uint32_t number;  ///< Index of the vertex in `Path::vertices`, at least 1.
  };

  /// Memory per subpath and per vertex, without polarisation [bytes].
  static constexpr std::size_t kBytesOfPath = sizeof(Sampler) + sizeof(std::uint32_t);
  static constexpr std::size_t kBytesOfVertex =
      sizeof(PathVertex) + sizeof(Vertex) + PhotonMap::kBytesOfPoint;

  /// Prepares for `paths` subpaths with the given packet and time (fraction of the exposure).
  void begin(std::size_t paths, const PathPacket& packet, float time);
  /// Stores batch number `batch`, the subpaths from index `batch` times `kBatchSize` on. Moves the vertices
  /// out of `paths`. Threads may store different batches concurrently.
  void store(std::size_t batch, std::span<RecordedPath> paths);
  /// Builds the spatial index over all vertices on scattering surfaces; `radius` is the merging radius [m].
  void finish(float radius);

  /// Number of subpaths.
  [[nodiscard]] std::size_t size() const { return size_; }
  /// Subpath of an index below `size()`.
  [[nodiscard]] Path operator[](std::size_t path) const;
  /// Sets `found` to the vertices closer to `point` than the merging radius, in the order of their subpaths.
  void find_nearby(const Imath::V3f& point, std::vector<Vertex>& found) const;

  [[nodiscard]] float radius() const { return radius_; }              ///< Merging radius [m].
  [[nodiscard]] const PathPacket& packet() const { return packet_; }  ///< Initial packet of all subpaths.
  [[nodiscard]] float time() const { return time_; }                  ///< Time of all subpaths.

 private:
  struct Batch {
    std::vector<PathVertex> vertices;  // of all subpaths in turn
    std::vector<std::uint32_t> ends;   // end of each subpath
    std::vector<Sampler> samplers;     // sampler of each subpath
  };

  std::vector<Batch> batches_;
  std::size_t size_ = 0;
  std::vector<Vertex> scattering_;
  PhotonMap map_{{}};  // of `scattering_`
  float radius_ = 0;
  PathPacket packet_;
  float time_ = 0;
};

/// Sample of a pixel: a camera subpath and a light subpath.
struct PixelPair {
  int x;           ///< Column of the pixel.
  int y;           ///< Row of the pixel.
  Sampler camera;  ///< Random numbers of the camera subpath.
  Sampler light;   ///< Random numbers of the light subpath.
  /// True if the camera subpath is traced; if not, only the light subpath exposes, at other pixels.
  bool exposes_pixel;
};

/// Bidirectional path tracing [Lafortune1993] [Veach1997, ch. 10]. A camera subpath and a light subpath with
/// the same wavelengths and hero are connected at their vertices; long subpaths at some of them only
/// (`choose_joined`). MIS: balance heuristic over all strategies and wavelengths.
///
/// With the light subpaths of a whole sample, a camera vertex is also merged with all light vertices close
/// by, as a further strategy: vertex connection and merging [Georgiev2012] [Hachisuka2012]. One instance per
/// thread.
///
/// Path classes owned:
/// - every path that ends on an area light;
/// - of paths that end on another light, those with two neighbouring vertices, the light's own included,
///   without a delta distribution;
/// - with merging, which blurs, also those with a single vertex without a delta distribution, on a surface.
///
/// Deposited values are those of one sample per pixel.
class BidirectionalTracer : public LayerSource {
 public:
  /// Plan and caster must outlive the tracer.
  BidirectionalTracer(const Plan& plan, RayCaster& caster);

  /// Traces the subpaths of all samples. Deposits each sum at its pixel, and connections to the camera at any
  /// pixel, all under the sample's index in `samples`. Throws Error{resource} if more than
  /// `MediumStack::kMaxShapes` media nest.
  void trace(std::span<const PixelPair> samples, const Deposit& deposit);

  /// Like the other `trace`, with light subpaths traced before, one per pixel of the film in the order of the
  /// rows. That of the sample's own pixel is connected, all are merged; `PixelPair::light` is not used.
  void trace(std::span<const PixelPair> samples, const LightSubpaths& subpaths, const Deposit& deposit);

 private:
  void trace_batch(std::span<const PixelPair> samples, std::uint32_t first);
  void join(std::uint32_t i);
  void join(std::uint32_t i, const JoinedVertex& x);
  void add_emission(std::uint32_t i, const EmitterHit& emitter_hit);
  void connect_to_light(std::uint32_t i, std::size_t t);
  void connect(std::uint32_t i, std::size_t t, std::size_t s);
  void connect_to_lens(std::uint32_t i, std::size_t s);
  void merge(std::uint32_t i, std::size_t t);
  void merge(std::uint32_t i, std::size_t t, const LightSubpaths::Vertex& at);
  [[nodiscard]] LightSubpaths::Path own_light_subpath(std::uint32_t i);
  void set_joined(std::uint32_t i, std::size_t t, const LightSubpaths::Path& photon, std::size_t s);
  void add_joined(std::uint32_t i, const FilmPoint& at);
  [[nodiscard]] float weight();
  [[nodiscard]] float path_tracing_fraction() const;
  [[nodiscard]] FilmPoint film_point(std::uint32_t i, std::size_t t, const PathVertex& b);
  void add(std::uint32_t i, const FilmPoint& at, std::uint32_t light, const SampledSpectrum& contribution,
           const std::optional<StokesSpectrum>& stokes);
  template <typename Contribution>
  void expose(std::uint32_t i, const FilmPoint& at, const Contribution& contribution);
  template <typename Contribution, typename DepositAt>
  void expose(std::uint32_t i, const FilmPoint& at, const Contribution& contribution, DepositAt deposit);

  const Plan& plan_;
  const Scene& scene_;
  RayCaster& caster_;
  bool probe_;  // the camera is a probe
  std::size_t max_vertices_;
  FilmResponse response_;
  PathRecorder<TransportMode::radiance> from_camera_;
  PathRecorder<TransportMode::power> from_light_;
  GhostLights ghosts_;
  const LightSubpaths* shared_subpaths_ = nullptr;  // nullptr if each sample traces its own
  const Deposit* deposit_ = nullptr;
  std::span<const PixelPair> samples_;    // samples of the current batch
  std::uint32_t first_ = 0;               // index of the first of them
  std::vector<FilmPoint> film_points_;    // film point of each sample
  std::vector<WavelengthImages> images_;  // film position per wavelength, for lenses that disperse them
  PathRadiance radiance_;                 // sums of each sample
  StrategyWeights weights_;
  JoinedPath joined_;
  float joining_weight_ = 1;                          // weight 1/p of the current connection
  std::vector<JoinedVertex> joined_camera_vertices_;  // vertices of the current subpaths to be connected
  std::vector<JoinedVertex> joined_light_vertices_;
  std::vector<LightSubpaths::Vertex> nearby_;  // light vertices near the current camera vertex
};

}  // namespace abbe
