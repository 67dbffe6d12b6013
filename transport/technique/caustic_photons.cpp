#include "transport/technique/caustic_photons.h"

#include <algorithm>
#include <limits>

namespace abbe {
namespace {

// Upper bound for float irradiances, for extremely bright lights.
constexpr double kMaxIrradiance = 1e30;

}  // namespace

CausticPhotonTracer::CausticPhotonTracer(const Plan& plan, RayCaster& caster,
                                         const std::vector<double>& sensor_emissions)
    : plan_(plan), caster_(caster), batch_(plan.scene, caster), sensor_emissions_(sensor_emissions) {}

std::span<const CausticPhotonTracer::TracedPhoton> CausticPhotonTracer::trace(
    std::span<const Sampler> photons) {
  traced_photons_.clear();
  std::vector<CausticPath>& paths = batch_.paths();
  paths.clear();
  for (std::uint32_t i = 0; i < photons.size(); ++i) {
    CausticPath& path = paths.emplace_back(photons[i], i);
    path.start = start_photon(plan_, caster_, path);
    if (path.packet.throughput.is_zero()) continue;
    path.prev_context.point = path.ray.origin;
    path.sensor_weight = static_cast<float>(
        sensor_emissions_[path.start.light] /
        static_cast<double>(plan_.scene.lights[path.start.light].emission(path.lambda_nm()).max()));
    if (plan_.scene.lights[path.start.light].at_infinity())
      path.distance = std::numeric_limits<float>::infinity();
    batch_.active().push_back(i);
  }
  batch_.run(*this);
  return traced_photons_;
}

void CausticPhotonTracer::prepare_scatter(CausticPath& path, const SurfaceVertex& vertex) {
  const float last = (vertex.hit.point - path.prev_context.point).length();
  path.distance += last;
  if (path.depth == 0 || !scatters(vertex.bsdf)) return;
  LightSampleContext context = vertex.light_context();
  context.glossy = false;  // includes ambient light
  const double unoccluded = plan_.path_lights.irradiance(context);
  traced_photons_.push_back({path.start,
                             {vertex.hit.point, -path.ray.direction, last, path.distance,
                              path.packet.throughput_estimate() * path.sensor_weight,
                              static_cast<float>(std::min(unoccluded, kMaxIrradiance))}});
}

}  // namespace abbe
