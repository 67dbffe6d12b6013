#include "transport/technique/light_subpaths.h"

#include <algorithm>
#include <iterator>
#include <variant>

namespace abbe {

void LightSubpaths::begin(std::size_t paths, const PathPacket& packet, float time) {
  batches_.resize((paths + kBatchSize - 1) / kBatchSize);
  size_ = paths;
  packet_ = packet;
  time_ = time;
}

void LightSubpaths::store(std::size_t batch, std::span<RecordedPath> paths) {
  Batch& stored = batches_[batch];
  stored.vertices.clear();
  stored.ends.clear();
  stored.samplers.clear();
  std::size_t vertices = 0;
  for (const RecordedPath& path : paths) vertices += path.vertices.size();
  stored.vertices.reserve(vertices);
  for (RecordedPath& path : paths) {
    std::ranges::move(path.vertices, std::back_inserter(stored.vertices));
    stored.ends.push_back(static_cast<std::uint32_t>(stored.vertices.size()));
    stored.samplers.push_back(path.sampler);
  }
}

void LightSubpaths::finish(float radius) {
  radius_ = radius;
  scattering_.clear();
  std::vector<Imath::V3f> points;
  for (std::uint32_t path = 0; path < size_; ++path) {
    const std::span<const PathVertex> vertices = (*this)[path].vertices;
    for (std::uint32_t k = 1; k < vertices.size(); ++k) {
      const auto* surface = std::get_if<SurfaceVertex>(&vertices[k].at);
      if (surface == nullptr || !scatters(surface->bsdf)) continue;
      scattering_.push_back({path, k});
      points.push_back(point_of(vertices[k]));
    }
  }
  map_ = PhotonMap(std::move(points));
}

LightSubpaths::Path LightSubpaths::operator[](std::size_t path) const {
  const Batch& batch = batches_[path / kBatchSize];
  const std::size_t i = path % kBatchSize;
  const std::size_t first = i == 0 ? 0 : batch.ends[i - 1];
  return {std::span(batch.vertices).subspan(first, batch.ends[i] - first), batch.samplers[i]};
}

void LightSubpaths::find_nearby(const Imath::V3f& point, std::vector<Vertex>& found) const {
  thread_local std::vector<std::uint32_t> numbers;
  map_.within(point, radius_, numbers);
  found.clear();
  for (const std::uint32_t number : numbers) found.push_back(scattering_[number]);
}

}  // namespace abbe
