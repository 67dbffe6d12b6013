#include "transport/technique/path.h"

#include <cmath>

#include "transport/path/equiangular.h"
#include "transport/path/polarised_ends.h"

// Path tracing in scattering media: connections from a vertex in a medium, along segments, and through media.

namespace abbe {

// Pdf with which `connect_equiangular` would have sampled that distance along the segment for the light.
float PathTracer::equiangular_pdf(const MediumSegment& segment, float distance, std::uint32_t light) const {
  const float pick_probability = plan_.equiangular_lights.probability(light);
  if (!(pick_probability > 0)) return 0;
  const auto distribution = Equiangular::along(segment.ray, segment.length, scene_.lights[light]);
  return distribution ? pick_probability * distribution->pdf(distance) : 0;
}

// The contribution at the distance t in a medium with the extinction s_k and scattering s'_k is
//     w sum_j [T_j / P_hero] s'_j e^(-s_j t) f_phase L_e / (q p),
// with the probability q of the light and the pdf p of t. It is balanced with scattering there, of pdf s_k
// e^(-s_k t), followed by next-event estimation.
void PathTracer::connect_equiangular(CameraPath& path, const MediumSegment& segment, const Imath::V2f& u) {
  if (path.seeks_caustic) return;
  const PowerLightSampler::SampledLight pick = plan_.equiangular_lights.pick(u.x);
  const Light& light = scene_.lights[pick.light];
  const auto distribution = Equiangular::along(segment.ray, segment.length, light);
  if (!distribution) return;
  const float t = distribution->sample(u.y);
  const Imath::V3f point = point_along(segment.ray, t, segment.length, segment.end_normal);
  const std::optional<LightSample> towards =
      sample_light(light, scene_.shapes, {point}, {0, 0}, path.ray.time);
  if (!towards) return;
  const MediumAt& medium = path.media.medium;
  SampledSpectrum transmittance(1.0F);
  medium.attenuate(transmittance, t);
  const Imath::V3f& wi = towards->wi;
  SampledSpectrum contribution = path.packet.throughput * transmittance * medium.scattering_per_m *
                                 emission_from(light, wi, path.lambda_nm()) *
                                 (pdf(medium.scattering->phase, segment.ray.direction, wi) * towards->factor);
  std::optional<StokesSpectrum> measured;
  if (path.packet.polarisation)
    measured = measure(path, mueller(medium.scattering->phase, segment.ray.direction, wi), light, wi);
  const float nee_pdf_after_scattering =
      (path.packet.lane_pdf * transmittance * medium.extinction_per_m).sum() / path.packet.lane_pdf.sum() *
      plan_.path_lights.probability(pick.light, {point}) * towards->pdf;
  connect_through_media(
      path, {pick.light, light, towards, pick.probability * distribution->pdf(t) + nee_pdf_after_scattering},
      contribution, SampledSpectrum(0.0F), ray_at(point, wi, path.ray.time), path.media, path.at.cos_film,
      measured);
}

void PathTracer::connect_in_medium(CameraPath& path, const PhaseFunction& phase,
                                   const std::array<float, 4>& u) {
  if (!connects()) return;
  ChosenLight chosen = choose_light({path.ray.origin, std::nullopt}, u, path.ray.time);
  if (!chosen.towards) return;
  if (connects_equiangular() && path.segment.length > 0)
    chosen.pdf +=
        equiangular_pdf(path.segment, (path.ray.origin - path.segment.ray.origin).length(), chosen.index) *
        path.segment.path_pdf / path.packet.lane_pdf.sum();
  const Imath::V3f& wi = chosen.towards->wi;
  const SampledSpectrum phase_pdf(pdf(phase, path.ray.direction, wi));
  const SampledSpectrum contribution =
      phase_pdf *
      (path.packet.throughput * emission_from(chosen.light, wi, path.lambda_nm()) * chosen.towards->factor);
  std::optional<StokesSpectrum> measured;
  SampledSpectrum scattering_pdf = chosen.light.is_delta() ? SampledSpectrum(0.0F) : phase_pdf;
  if (path.packet.polarisation) {
    const Polarisation rows = path.packet.polarisation->through(
        mueller(phase, path.ray.direction, wi), light_travels(path.ray.direction, kMode), kMode);
    measured = rows.of(emitted_polarisation(chosen.light, -wi), -wi);
    scattering_pdf *= rows.of_unpolarised().i;  // sampled with the polarised pdf
  }
  connect_through_media(path, chosen, contribution, scattering_pdf,
                        ray_at(path.ray.origin, wi, path.ray.time), path.media, path.at.cos_film, measured);
}

// Queues a connection through media. `scattering_pdf` is the pdf with which scattering samples the direction
// of `ray`. Transmittance and weight are applied after the shadow rays of the step are traced.
[[gnu::noinline]] void PathTracer::connect_through_media(const CameraPath& path, const ChosenLight& chosen,
                                                         const SampledSpectrum& contribution,
                                                         const SampledSpectrum& scattering_pdf,
                                                         const Ray& ray, const MediumState& media,
                                                         float cos_film,
                                                         const std::optional<StokesSpectrum>& measured) {
  connections_.push_back({path.index, {chosen.index, path.depth + 1}, contribution, cos_film});
  if (measured) measured_stokes_.push_back(*measured);
  through_media_.push_back({ray, media, path.packet.lane_pdf * scattering_pdf, chosen.pdf,
                            path.packet.lane_pdf.sum(), chosen.towards->distance});
  shadow_rays_.push_back(shadow_ray(ray, *chosen.towards));
}

// Applies transmittance and MIS weight to an unoccluded connection. Returns false if the weight is not
// finite.
[[gnu::noinline]] bool PathTracer::apply_transmittance(Connection& connection, const ThroughMedia& segment) {
  const SampledSpectrum& wavelengths_nm = batch_.paths()[connection.path].lambda_nm();
  const Transmission through =
      transmission(scene_, caster_, segment.ray, segment.media, wavelengths_nm, segment.distance);
  const float weight =
      weights_.connection_weight(segment.scattering_pdf * through.pdf, segment.light_pdf, segment.path_pdf);
  connection.contribution *= through.transmittance * weight;
  return std::isfinite(weight);
}

}  // namespace abbe
