#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sampling/sampler.h"
#include "transport/path/path_recorder.h"
#include "transport/path/photon_map.h"

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

}  // namespace abbe
