#include "transport/technique/path.h"

#include <cmath>

#include "transport/path/equiangular.h"
#include "transport/path/polarised_ends.h"

// Path tracing where matter scatters: connections from within, along stretches, and through what lies
// between.

namespace abbe {

// With which `connect_along` would have connected that place of the stretch to the light.
float PathTracer::pdf_along(const Stretch& stretch, float distance, std::uint32_t light) const {
  const float picked = plan_.lights_along.probability(light);
  if (!(picked > 0)) return 0;
  const auto part = Equiangular::along(stretch.ray, stretch.length, scene_.lights[light]);
  return part ? picked * part->pdf(distance) : 0;
}

// At t along matter of the extinction s_k and scattering s'_k, with q the probability of the light and p the
// density of t, the light brought to the path is
//     w sum_j [T_j / P_hero] s'_j e^(-s_j t) f_phase L_e / (q p),
// balanced with what comes of scattering there, of the density s_k e^(-s_k t), and connecting then.
void PathTracer::connect_along(CameraPath& path, const Stretch& stretch, const Imath::V2f& u) {
  if (path.seeks_caustic) return;
  const PowerLightSampler::SampledLight pick = plan_.lights_along.pick(u.x);
  const Light& light = scene_.lights[pick.light];
  const auto part = Equiangular::along(stretch.ray, stretch.length, light);
  if (!part) return;
  const float t = part->sample(u.y);
  const Imath::V3f point = point_along(stretch.ray, t, stretch.length, stretch.end_normal);
  const std::optional<LightSample> towards =
      sample_light(light, scene_.shapes, {point}, {0, 0}, path.ray.time);
  if (!towards) return;
  const MediumAt& medium = path.around.medium;
  SampledSpectrum passed(1.0F);
  medium.attenuate(passed, t);
  const Imath::V3f& wi = towards->wi;
  SampledSpectrum contribution = path.packet.throughput * passed * medium.scattering_per_m *
                                 emission_from(light, wi, path.lambda_nm()) *
                                 (pdf(medium.scattering->phase, stretch.ray.direction, wi) * towards->factor);
  std::optional<StokesSpectrum> seen;
  if (path.packet.polarisation)
    seen = measured(path, mueller(medium.scattering->phase, stretch.ray.direction, wi), light, wi);
  const float scattered = (path.packet.lane_pdf * passed * medium.extinction_per_m).sum() /
                          path.packet.lane_pdf.sum() * plan_.path_lights.probability(pick.light, {point}) *
                          towards->pdf;
  connect_through_matter(path, {pick.light, light, towards, pick.probability * part->pdf(t) + scattered},
                         contribution, SampledSpectrum(0.0F), ray_at(point, wi, path.ray.time), path.around,
                         path.at.cos_film, seen);
}

void PathTracer::connect_within(CameraPath& path, const PhaseFunction& phase, const std::array<float, 4>& u) {
  if (!connects()) return;
  ChosenLight chosen = choose_light({path.ray.origin, std::nullopt}, u, path.ray.time);
  if (!chosen.towards) return;
  if (connects_along() && path.stretch.length > 0)
    chosen.pdf +=
        pdf_along(path.stretch, (path.ray.origin - path.stretch.ray.origin).length(), chosen.index) *
        path.stretch.lanes / path.packet.lane_pdf.sum();
  const Imath::V3f& wi = chosen.towards->wi;
  const SampledSpectrum turned(pdf(phase, path.ray.direction, wi));
  const SampledSpectrum contribution =
      turned *
      (path.packet.throughput * emission_from(chosen.light, wi, path.lambda_nm()) * chosen.towards->factor);
  std::optional<StokesSpectrum> seen;
  SampledSpectrum scattering_pdf = chosen.light.is_delta() ? SampledSpectrum(0.0F) : turned;
  if (path.packet.polarisation) {
    const Polarisation rows = path.packet.polarisation->through(
        mueller(phase, path.ray.direction, wi), light_travels(path.ray.direction, kMode), kMode);
    seen = rows.of(polarisation_of_lamp(chosen.light, -wi), -wi);
    scattering_pdf *= rows.of_unpolarised().i;  // it is drawn as polarised light has it
  }
  connect_through_matter(path, chosen, contribution, scattering_pdf,
                         ray_at(path.ray.origin, wi, path.ray.time), path.around, path.at.cos_film, seen);
}

// Of the light that comes along `ray`, the direction of which scattering would have drawn with
// `scattering_pdf`, what is left is added once all ways of the step are known to be open.
[[gnu::noinline]] void PathTracer::connect_through_matter(const CameraPath& path, const ChosenLight& chosen,
                                                          const SampledSpectrum& contribution,
                                                          const SampledSpectrum& scattering_pdf,
                                                          const Ray& ray, const Surroundings& around,
                                                          float cos_film,
                                                          const std::optional<StokesSpectrum>& seen) {
  connections_.push_back({path.path, {chosen.index, path.events + 1}, contribution, cos_film});
  if (seen) seen_.push_back(*seen);
  through_.push_back({ray, around, path.packet.lane_pdf * scattering_pdf, chosen.pdf,
                      path.packet.lane_pdf.sum(), chosen.towards->distance});
  ways_.push_back(way_to(ray, *chosen.towards));
}

// Follows the open way of a connection, and weighs it by what comes through. Whether there is a weight.
[[gnu::noinline]] bool PathTracer::pass_matter(Connection& connection, const ThroughMatter& way) {
  const SampledSpectrum& wavelengths_nm = walks_.paths()[connection.path].lambda_nm();
  const Transmission through =
      transmission(scene_, caster_, way.ray, way.around, wavelengths_nm, way.distance);
  const float weight =
      weights_.of_connection(way.scattering_pdf * through.density, way.light_pdf, way.path_pdf);
  connection.contribution *= through.transmittance * weight;
  return std::isfinite(weight);
}

}  // namespace abbe
