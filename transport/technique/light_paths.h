#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sampling/sampler.h"
#include "transport/path/path_recorder.h"
#include "transport/path/photon_map.h"

namespace abbe {

/// The paths from lights of a sample, all of one packet, to be joined to any path from its camera: without
/// what only walking needs, by batches of `kPathsTogether`. Those of the next sample take over their memory.
class LightPaths {
 public:
  /// One that has come to its end.
  struct Path {
    std::span<const PathVertex> vertices;  ///< The first is on the light; none where it got nowhere.
    Sampler sampler;                       ///< Its numbers.
  };
  /// A vertex on a surface that scatters, to be found by place.
  struct Vertex {
    std::uint32_t path;
    std::uint32_t number;
  };

  /// What a path takes in memory, and each of its vertices, without polarisation [bytes].
  static constexpr std::size_t kBytesOfPath = sizeof(Sampler) + sizeof(std::uint32_t);
  static constexpr std::size_t kBytesOfVertex =
      sizeof(PathVertex) + sizeof(Vertex) + PhotonMap::kBytesOfPoint;

  /// Makes place for so many paths of that packet and time [s].
  void begin(std::size_t paths, const PathPacket& packet, float time);
  /// Takes the vertices of those of a batch. Threads may keep different ones at once.
  void keep(std::size_t batch, std::span<RecordedPath> paths);
  /// When all are kept: they are to be merged within `radius` [m].
  void end(float radius);

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] Path operator[](std::size_t path) const;
  /// Sets `found` to the vertices within the radius around a point, in the order of their paths.
  void near(const Imath::V3f& point, std::vector<Vertex>& found) const;

  [[nodiscard]] float radius() const { return radius_; }
  [[nodiscard]] const PathPacket& packet() const { return packet_; }  ///< That all set out with,
  [[nodiscard]] float time() const { return time_; }                  ///< and when.

 private:
  struct Batch {
    std::vector<PathVertex> vertices;  // of one path after the other,
    std::vector<std::uint32_t> ends;   // where each ends,
    std::vector<Sampler> samplers;     // and its numbers
  };

  std::vector<Batch> batches_;
  std::size_t size_ = 0;
  std::vector<Vertex> scattering_;
  PhotonMap map_{{}};  // of them, by their numbers
  float radius_ = 0;
  PathPacket packet_;
  float time_ = 0;
};

}  // namespace abbe
