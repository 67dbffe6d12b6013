#include "transport/technique/caustic_photons.h"

#include <algorithm>
#include <limits>

namespace abbe {
namespace {

// That a float holds, of lamps that are brighter than any.
constexpr double kMostIrradiance = 1e30;

}  // namespace

CausticPhotonTracer::CausticPhotonTracer(const Plan& plan, RayCaster& caster, const std::vector<double>& seen)
    : plan_(plan), caster_(caster), walks_(plan.scene, caster), seen_(seen) {}

std::span<const CausticPhotonTracer::Arrival> CausticPhotonTracer::trace(std::span<const Sampler> photons) {
  arrivals_.clear();
  std::vector<CausticPath>& paths = walks_.paths();
  paths.clear();
  for (std::uint32_t i = 0; i < photons.size(); ++i) {
    CausticPath& path = paths.emplace_back(photons[i], i);
    path.start = start_photon(plan_, caster_, path);
    if (path.packet.throughput.is_zero()) continue;
    path.last.point = path.ray.origin;
    path.seen = static_cast<float>(
        seen_[path.start.light] /
        static_cast<double>(plan_.scene.lights[path.start.light].emission(path.lambda_nm()).max()));
    if (plan_.scene.lights[path.start.light].at_infinity())
      path.distance = std::numeric_limits<float>::infinity();
    walks_.going().push_back(i);
  }
  walks_.run(*this);
  return arrivals_;
}

void CausticPhotonTracer::reach(CausticPath& path, const SurfaceVertex& vertex) {
  const float last = (vertex.hit.point - path.last.point).length();
  path.distance += last;
  if (path.events == 0 || !scatters(vertex.bsdf)) return;
  LightSampleContext place = vertex.place();
  place.glossy = false;  // all light of the place
  const double unhindered = plan_.path_lights.irradiance(place);
  arrivals_.push_back(
      {path.start,
       {vertex.hit.point, -path.ray.direction, last, path.distance, path.packet.carried() * path.seen,
        static_cast<float>(std::min(unhindered, kMostIrradiance))}});
}

}  // namespace abbe
