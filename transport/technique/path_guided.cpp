#include "transport/technique/path.h"

#include <algorithm>
#include <cmath>

// Path tracing with the caustic guide.
//
// A direction w is sampled by two techniques: scattering, with the pdf s(w), and with the probability q a
// second path, whose direction has the guide's pdf g(w). Emitter hits that follow w by specular events alone
// are balanced over both [Veach1997, eq. 9.8], each counted as often as it is sampled:
//     w_s = s / (s + q g),   w_g = q g / (s + q g).
// Scattering alone samples all other light, and the guide does not change it: no weight exceeds that of
// scattering, whatever q is. A one-sample mixture, which replaces scattering with the probability q,
// multiplies weights by up to 1/(1 - q) at each event. In a room of albedo a the second moment of a path, the
// sum over n of (a^2/(1 - q))^n, then diverges for q > 1 - a^2.
//
// q is the guide's probability times the throughput T of the path, at most 1. Light of the paths added at a
// vertex of throughput T has a variance in proportion to T^2/q and a cost in proportion to q. q is therefore
// best in proportion to T, as `kCameraRouletteScale` derives for roulette.

namespace abbe {

// Photons own light from specular surfaces of traced lights. Exceptions are light that a camera receives
// through specular surfaces, and light that a surface or medium scatters to a probe.
void PathTracer::prepare_scatter(CameraPath& path, const SurfaceVertex& vertex) const {
  path.caustics = {};
  if (path.seeks_caustic || (restricts_acceptance_ && path.depth == kProbeDepth)) return;
  const bool includes_traced = path.owns_caustics || (camera_.probe_acceptance && path.depth == 0);
  const CausticGuide& guide =
      includes_traced ? plan_.guides.caustics_through_specular : plan_.guides.path_caustics;
  if (guide.empty() || !scatters(vertex.bsdf)) return;
  path.caustics = guide.at(vertex.hit.point).scaled(std::min(1.0F, roulette_throughput(path)));
}

std::optional<float> PathTracer::adds_path(const CameraPath& path) const {
  if (path.caustics.empty()) return std::nullopt;
  const float q = path.caustics.probability();
  const float u = path.sampler.group(guide_group(path.depth))[3];
  return u < q ? std::optional(u / q) : std::nullopt;
}

// Roulette uses the throughput that BSDF sampling would have had: the guide's pdf lowers the throughput of a
// path, but not its importance.
std::optional<BsdfSample> PathTracer::scatter_added(CameraPath& path, const SurfaceVertex& vertex) const {
  const std::array<float, 4> u = path.sampler.group(guide_group(path.depth));
  const Imath::V3f& point = vertex.hit.point;
  const Imath::V3f world = path.caustics.sample(point, u[2], {u[0], u[1]});
  const auto [wi, f, crosses] = vertex.eval_towards(world, kMode);
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
  if (path.depth == 0) path.owns_caustics = camera_.probe_acceptance.has_value();
  path.seeks_caustic = true;
  path.guided.lobes = {};
  path.spare_u.reset();
  path.sampler = path.sampler.branch(static_cast<std::uint32_t>(path.depth - kProbeDepth));
  if (path.depth == kProbeDepth) path.at.cos_film = wi.z;
  return event;
}

// Pdf of a path up to an emitter hit, per wavelength, relative to that of its throughput. It includes the
// guide's pdf if only specular events follow a vertex where the guide has lobes.
SampledSpectrum PathTracer::pdf_with_guide(const CameraPath& path) const {
  const GuidedScattering& last = path.guided;
  if (path.nee_path_pdf > 0 || last.lobes.empty()) return path.packet.lane_pdf;
  const SampledSpectrum combined = last.lobes.combined_pdf(last.pdf, last.point, last.direction);
  return path.packet.lane_pdf *
         SampledSpectrum::map(combined, last.pdf, [](float combined_pdf, float scattering) {
           return scattering > 0 ? combined_pdf / scattering : 1;
         });
}

}  // namespace abbe
