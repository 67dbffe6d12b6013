#include "transport/technique/photons.h"

#include <algorithm>
#include <utility>

#include "transport/technique/subpaths.h"

namespace abbe {
namespace {

std::vector<Imath::V3f> positions_of(const std::vector<Photon>& photons) {
  std::vector<Imath::V3f> points(photons.size());
  std::transform(photons.begin(), photons.end(), points.begin(), [](const Photon& p) { return p.point; });
  return points;
}

}  // namespace

PhotonTracer::PhotonTracer(const Plan& plan, RayCaster& caster)
    : plan_(plan), caster_(caster), batch_(plan.scene, caster) {}

void PhotonTracer::trace(std::span<const Sampler> samplers, const PathPacket& packet, float time,
                         std::vector<Photon>& photons) {
  path_photons_.clear();
  scattered_.assign(samplers.size(), false);
  std::vector<RecordedPath>& paths = batch_.paths();
  paths.clear();
  for (std::uint32_t i = 0; i < samplers.size(); ++i) {
    RecordedPath& path = paths.emplace_back(samplers[i], i);
    path.packet = packet;
    start_from_light(plan_, caster_, time, path);
    if (!path.vertices.empty()) batch_.active().push_back(i);
  }
  batch_.run(*this);
  std::sort(path_photons_.begin(), path_photons_.end(), [](const PathPhoton& a, const PathPhoton& b) {
    return std::pair(a.path, a.photon.depth) < std::pair(b.path, b.photon.depth);
  });
  for (const PathPhoton& stored : path_photons_) photons.push_back(stored.photon);
}

void PhotonTracer::connect(RecordedPath& path, const SurfaceVertex& vertex,
                           const std::array<float, 4>& /*u*/) {
  if (path.depth == 0) return;
  path_photons_.push_back(
      {path.index,
       {vertex.hit.point, vertex.hit.normal, -path.ray.direction, path.packet.throughput,
        path.packet.lane_pdf, path.depth, std::get<LightVertex>(path.vertices.front().at).light,
        !scattered_[path.index], path.packet.polarisation}});
}

void PhotonTracer::connect_in_medium(RecordedPath& path, const PhaseFunction& /*phase*/,
                                     const std::array<float, 4>& /*u*/) {
  scattered_[path.index] = true;
}

PhotonCloud::PhotonCloud(std::vector<Photon> stored_photons, std::uint64_t traced,
                         const PathPacket& start_packet, float start_time)
    : photons(std::move(stored_photons)),
      map(positions_of(photons)),
      paths(traced),
      packet(start_packet),
      time(start_time) {}

}  // namespace abbe
