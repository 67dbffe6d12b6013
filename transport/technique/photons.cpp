#include "transport/technique/photons.h"

#include <algorithm>
#include <utility>

#include "transport/technique/subpaths.h"

namespace abbe {
namespace {

std::vector<Imath::V3f> places_of(const std::vector<Photon>& photons) {
  std::vector<Imath::V3f> places(photons.size());
  std::transform(photons.begin(), photons.end(), places.begin(), [](const Photon& p) { return p.point; });
  return places;
}

}  // namespace

PhotonTracer::PhotonTracer(const Plan& plan, RayCaster& caster)
    : plan_(plan), caster_(caster), walks_(plan.scene, caster) {}

void PhotonTracer::trace(std::span<const Sampler> samplers, const PathPacket& packet, float time,
                         std::vector<Photon>& photons) {
  left_.clear();
  scattered_.assign(samplers.size(), false);
  std::vector<RecordedPath>& paths = walks_.paths();
  paths.clear();
  for (std::uint32_t i = 0; i < samplers.size(); ++i) {
    RecordedPath& path = paths.emplace_back(samplers[i], i);
    path.packet = packet;
    start_from_light(plan_, caster_, time, path);
    if (!path.vertices.empty()) walks_.going().push_back(i);
  }
  walks_.run(*this);
  std::sort(left_.begin(), left_.end(), [](const Left& a, const Left& b) {
    return std::pair(a.path, a.photon.events) < std::pair(b.path, b.photon.events);
  });
  for (const Left& left : left_) photons.push_back(left.photon);
}

void PhotonTracer::connect(RecordedPath& path, const SurfaceVertex& vertex,
                           const std::array<float, 4>& /*u*/) {
  if (path.events == 0) return;
  left_.push_back({path.path,
                   {vertex.hit.point, vertex.hit.normal, -path.ray.direction, path.packet.throughput,
                    path.packet.lane_pdf, path.events, std::get<LightVertex>(path.vertices.front().at).light,
                    !scattered_[path.path], path.packet.polarisation}});
}

void PhotonTracer::connect_within(RecordedPath& path, const PhaseFunction& /*phase*/,
                                  const std::array<float, 4>& /*u*/) {
  scattered_[path.path] = true;
}

PhotonCloud::PhotonCloud(std::vector<Photon> left, std::uint64_t traced, const PathPacket& of, float at)
    : photons(std::move(left)), map(places_of(photons)), paths(traced), packet(of), time(at) {}

}  // namespace abbe
