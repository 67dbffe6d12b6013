#include "transport/technique/light_paths.h"

#include <algorithm>
#include <iterator>
#include <variant>

namespace abbe {

void LightPaths::begin(std::size_t paths, const PathPacket& packet, float time) {
  batches_.resize((paths + kPathsTogether - 1) / kPathsTogether);
  size_ = paths;
  packet_ = packet;
  time_ = time;
}

void LightPaths::keep(std::size_t batch, std::span<RecordedPath> paths) {
  Batch& kept = batches_[batch];
  kept.vertices.clear();
  kept.ends.clear();
  kept.samplers.clear();
  std::size_t vertices = 0;
  for (const RecordedPath& path : paths) vertices += path.vertices.size();
  kept.vertices.reserve(vertices);
  for (RecordedPath& path : paths) {
    std::ranges::move(path.vertices, std::back_inserter(kept.vertices));
    kept.ends.push_back(static_cast<std::uint32_t>(kept.vertices.size()));
    kept.samplers.push_back(path.sampler);
  }
}

void LightPaths::end(float radius) {
  radius_ = radius;
  scattering_.clear();
  std::vector<Imath::V3f> places;
  for (std::uint32_t path = 0; path < size_; ++path) {
    const std::span<const PathVertex> vertices = (*this)[path].vertices;
    for (std::uint32_t k = 1; k < vertices.size(); ++k) {
      const auto* surface = std::get_if<SurfaceVertex>(&vertices[k].at);
      if (surface == nullptr || !scatters(surface->bsdf)) continue;
      scattering_.push_back({path, k});
      places.push_back(point_of(vertices[k]));
    }
  }
  map_ = PhotonMap(std::move(places));
}

LightPaths::Path LightPaths::operator[](std::size_t path) const {
  const Batch& batch = batches_[path / kPathsTogether];
  const std::size_t i = path % kPathsTogether;
  const std::size_t first = i == 0 ? 0 : batch.ends[i - 1];
  return {std::span(batch.vertices).subspan(first, batch.ends[i] - first), batch.samplers[i]};
}

void LightPaths::near(const Imath::V3f& point, std::vector<Vertex>& found) const {
  thread_local std::vector<std::uint32_t> numbers;
  map_.within(point, radius_, numbers);
  found.clear();
  for (const std::uint32_t number : numbers) found.push_back(scattering_[number]);
}

}  // namespace abbe
