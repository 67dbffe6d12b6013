#include "transport/technique/path.h"

#include <algorithm>
#include <cmath>

// Path tracing with the caustic guide.
//
// A direction w leaves a vertex in two ways: by scattering, with the density s(w), and with the probability q
// by one more path, whose direction has the guide's density g(w). Light that w leads to through specular
// events alone is balanced over both [Veach1997, eq. 9.8], each counted as often as it is drawn:
//     w_s = s / (s + q g),   w_g = q g / (s + q g).
// Scattering alone samples all other light, and the guide does not change it: no weight exceeds that of
// scattering, whatever q is. A one-sample mixture, which replaces scattering with the probability q,
// multiplies weights by up to 1/(1 - q) at each event. In a room of albedo a the second moment of a path, the
// sum over n of (a^2/(1 - q))^n, then diverges for q > 1 - a^2.
//
// q is the guide's probability times the throughput T of the path, at most 1. Light of the paths added at a
// vertex of throughput T has a variance in proportion to T^2/q and a cost in proportion to q. q is therefore
// best in proportion to T, as `kGoingOnOfCameraPaths` derives for roulette.

namespace abbe {

// The photons bring what comes through specular matter from traced lights, but for what a camera sees through
// it, and for what a surface or matter scatters to a meter.
void PathTracer::reach(CameraPath& path, const SurfaceVertex& vertex) const {
  path.caustics = {};
  if (path.seeks_caustic || (narrow_ && path.events == kMeterEvent)) return;
  const bool of_traced = path.owns_caustics || (camera_.meter_acceptance && path.events == 0);
  const CausticGuide& guide = of_traced ? plan_.guides.caustics_seen_through : plan_.guides.caustics_of_paths;
  if (guide.empty() || !scatters(vertex.bsdf)) return;
  path.caustics = guide.at(vertex.hit.point).scaled(std::min(1.0F, roulette_throughput(path)));
}

std::optional<float> PathTracer::adds_path(const CameraPath& path) const {
  if (path.caustics.empty()) return std::nullopt;
  const float q = path.caustics.share();
  const float u = path.sampler.group(guide_group(path.events))[3];
  return u < q ? std::optional(u / q) : std::nullopt;
}

// Roulette uses the throughput that scattering would have had: the guide's density lowers the throughput of a
// path, but not its importance.
std::optional<BsdfSample> PathTracer::scatter_added(CameraPath& path, const SurfaceVertex& vertex) const {
  const std::array<float, 4> u = path.sampler.group(guide_group(path.events));
  const Imath::V3f& point = vertex.hit.point;
  const Imath::V3f world = path.caustics.sample(point, u[2], {u[0], u[1]});
  const auto [wi, f, crosses] = vertex.towards(world, kMode);
  if (f.is_zero()) return std::nullopt;
  const SampledSpectrum scattering_pdf = unguided_pdf(vertex, wi);
  const SampledSpectrum combined = path.caustics.combined_pdf(scattering_pdf, point, world);
  BsdfSample event;
  event.wi = wi;
  event.transmitted = crosses;
  event.pdf = combined[path.packet.hero];
  if (!(event.pdf > 0)) return std::nullopt;
  event.weight = f * (std::abs(wi.z) / event.pdf);
  event.lane_pdf = combined * (1 / event.pdf);
  path.eta_scale *= combined.max() / scattering_pdf.max();
  if (path.events == 0) path.owns_caustics = camera_.meter_acceptance.has_value();
  path.seeks_caustic = true;
  path.guided.lobes = {};
  path.left_over.reset();
  path.sampler = path.sampler.branch(static_cast<std::uint32_t>(path.events - kMeterEvent));
  if (path.events == kMeterEvent) path.at.cos_film = wi.z;
  return event;
}

// Density of a path up to an emitter hit, relative to that of its throughput. It includes the guide's density
// if only specular events follow a vertex where the guide has lobes.
SampledSpectrum PathTracer::pdf_with_guide(const CameraPath& path) const {
  const GuidedScattering& last = path.guided;
  if (path.connected > 0 || last.lobes.empty()) return path.packet.lane_pdf;
  const SampledSpectrum combined = last.lobes.combined_pdf(last.pdf, last.point, last.direction);
  return path.packet.lane_pdf * SampledSpectrum::map(combined, last.pdf, [](float both, float scattering) {
           return scattering > 0 ? both / scattering : 1;
         });
}

}  // namespace abbe
