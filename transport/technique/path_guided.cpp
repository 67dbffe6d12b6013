#include "transport/technique/path.h"

#include <algorithm>
#include <cmath>

// Path tracing that looks for caustics where photons have shown them.

namespace abbe {

// The photons bring what comes through specular matter from traced lights, but for what a camera sees through
// it, and for what a surface or matter scatters to a meter.
void PathTracer::reach(CameraPath& path, const SurfaceVertex& vertex) const {
  if (narrow_ && path.events == kMeterEvent) return;
  const bool of_traced = path.owns_caustics || (camera_.meter_acceptance && path.events == 0);
  const CausticGuide& guide = of_traced ? plan_.guides.caustics_seen_through : plan_.guides.caustics_of_paths;
  path.caustics = !guide.empty() && scatters(vertex.bsdf) ? guide.at(vertex.hit.point) : CausticLobes();
}

// A direction drawn from the guide or as without it, by chance. Roulette must not take what the guide draws
// the more often the less likely for what it carries less: what that is over is counted as still there.
[[gnu::noinline]] std::optional<BsdfSample> PathTracer::scatter_guided(CameraPath& path,
                                                                       const SurfaceVertex& vertex,
                                                                       BsdfRandom u) const {
  const float share = path.caustics.share();
  const bool guided = u.lobe < share;
  u.lobe = guided ? u.lobe / share : (u.lobe - share) / (1 - share);
  std::optional<BsdfSample> event;
  SampledSpectrum scattered;       // f cos
  SampledSpectrum scattering_pdf;  // of each lane
  Imath::V3f world;
  if (guided) {
    world = path.caustics.sample(vertex.hit.point, u.lobe, u.direction);
    const auto [wi, f, crosses] = vertex.towards(world, kMode);
    if (f.is_zero()) return std::nullopt;
    scattered = f * std::abs(wi.z);
    scattering_pdf = unguided_pdf(vertex, wi);
    event.emplace().wi = wi;
    event->transmitted = crosses;
  } else {
    event = scatter_unguided(path, vertex, u);
    if (!event) return event;
    if (event->delta) {
      event->weight *= 1 / (1 - share);
      event->pdf *= 1 - share;
      return event;
    }
    world = vertex.frame.to_world(event->wi);
    scattered = event->weight * event->pdf;
    scattering_pdf = event->lane_pdf * event->pdf;
  }
  const SampledSpectrum mixed = path.caustics.mixed_pdf(scattering_pdf, vertex.hit.point, world);
  event->pdf = mixed[path.packet.hero];
  if (!(event->pdf > 0)) return std::nullopt;
  event->weight = scattered * (1 / event->pdf);
  event->lane_pdf = mixed * (1 / event->pdf);
  path.eta_scale *= std::max(1.0F, mixed.max() / scattering_pdf.max());
  return event;
}

}  // namespace abbe
