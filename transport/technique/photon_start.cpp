#include "transport/technique/photon_start.h"

#include <array>
#include <cmath>
#include <numbers>

#include "scene/scene_features.h"
#include "scene/shapes/ray.h"
#include "transport/path/dimensions.h"
#include "transport/path/polarised_ends.h"
#include "transport/technique/start_media.h"

namespace abbe {
namespace {

// Initial ray of a photon; its power is the light's emission times `factor`, which is 0 if no light is
// emitted.
struct PhotonRay {
  Ray ray;
  float factor = 0;
};

// Random numbers in [0, 1) for the start of a photon.
struct PhotonRandom {
  Imath::V2f guide;  // direction, or point of the target
  Imath::V2f start;  // point of the light, or direction of a sun
  float choice;      // selects guide or emission
  float time;        // fraction of the exposure
};

bool emits_in_direction(const Light& light, const EmissionPoint& from, const Imath::V3f& wi, float time) {
  if (const auto* spot = std::get_if<SpotLight>(&light.kind)) return spot->illuminates(wi, time);
  return emits_towards(light, from.normal, wi);
}

// Photon of a nearby light, in a direction of its guide: L_e |cos| / (q p_area p_direction), q being the
// probability of the light.
PhotonRay start_near(const Plan& plan, const PowerLightSampler::SampledLight& pick, const PhotonRandom& u) {
  const Light& light = plan.scene.lights[pick.light];
  const EmissionPoint from = sample_emission_point(light, plan.scene.shapes, u.start, u.time);
  const GuidedDirection guided =
      plan.guides.photon_guides[pick.light].sample(light, from, u.choice, u.guide, u.time);
  if (!emits_in_direction(light, from, guided.wi, u.time)) return {};
  const bool area = light.is<AreaLight>();
  const float cosine = area ? std::abs(from.normal.dot(guided.wi)) : 1.0F;
  return {area ? spawn(from.point, from.normal, guided.wi, u.time) : ray_at(from.point, guided.wi, u.time),
          cosine / (pick.probability * from.pdf_area * guided.pdf)};
}

// Ray through a point of the target, from outside the target's sphere.
Ray ray_through_target(const PhotonGuide& guide, const GuidedPoint& at, const Imath::V3f& direction,
                       float time) {
  return ray_at(at.point - direction * (2 * guide.half_size()), direction, time);
}

// Photon of a distant light, through a point of the target at the distance d: L_e |cos_light cos_target| / (q
// p_light p_target d^2).
PhotonRay start_distant(const Plan& plan, RayCaster& caster, const PowerLightSampler::SampledLight& pick,
                        const PhotonRandom& u) {
  const Light& light = plan.scene.lights[pick.light];
  const PhotonGuide& guide = plan.guides.photon_guides[pick.light];
  const EmissionPoint from = sample_emission_point(light, plan.scene.shapes, u.start, u.time);
  const GuidedPoint at = guide.point(u.guide);
  const Imath::V3d to_target = Imath::V3d(at.point) - Imath::V3d(from.point);
  const double distance = to_target.length();
  const Imath::V3f wi(to_target * (1 / distance));
  const Ray ray = ray_through_target(guide, at, wi, u.time);
  if (!emits_in_direction(light, from, wi, u.time)) return {ray};
  const bool area = light.is<AreaLight>();
  if (caster.occluded(shadow_ray_between(
          ray.origin, area ? offset_point(from.point, from.normal, wi) : from.point, u.time)))
    return {ray};
  const float cosines = (area ? std::abs(from.normal.dot(wi)) : 1.0F) * std::abs(guide.axis().dot(wi));
  const double density = static_cast<double>(pick.probability * from.pdf_area) * static_cast<double>(at.pdf) *
                         distance * distance;
  return {ray, static_cast<float>(static_cast<double>(cosines) / density)};
}

// Photon of a light at infinity, through a point of the target: L_e |cos_target| / (q p_target p_direction).
PhotonRay start_at_infinity(const Plan& plan, RayCaster& caster, const PowerLightSampler::SampledLight& pick,
                            const PhotonRandom& u) {
  const Light& light = plan.scene.lights[pick.light];
  const PhotonGuide& guide = plan.guides.photon_guides[pick.light];
  const LightSample from = *sample_light(light, plan.scene.shapes, {}, u.start, u.time);
  const GuidedPoint at = guide.point(u.guide);
  const Ray ray = ray_through_target(guide, at, -from.wi, u.time);
  if (caster.occluded(shadow_ray_along(ray_at(ray.origin, from.wi, u.time)))) return {ray};
  const float cosine = std::abs(guide.axis().dot(from.wi));
  return {ray, cosine / (pick.probability * at.pdf * from.pdf)};
}

PhotonRay start_ray(const Plan& plan, RayCaster& caster, const PowerLightSampler::SampledLight& pick,
                    const PhotonRandom& u) {
  const Light& light = plan.scene.lights[pick.light];
  if (light.at_infinity()) return start_at_infinity(plan, caster, pick, u);
  return plan.scene.is_distant(light) ? start_distant(plan, caster, pick, u) : start_near(plan, pick, u);
}

}  // namespace

PhotonStart start_photon(const Plan& plan, RayCaster& caster, PathState& photon) {
  const std::array<float, 4> a = photon.sampler.group(kPhotonGuideGroup);
  const std::array<float, 4> b = photon.sampler.group(kEmissionGroup);
  const PowerLightSampler::SampledLight pick = plan.traced_lights.pick(b[3]);
  const PhotonRay start = start_ray(plan, caster, pick, {{a[0], a[1]}, {b[0], b[1]}, b[2], a[kTimeIndex]});
  PhotonStart result{pick.light, start.ray.origin, start.ray.direction};
  if (!(start.factor > 0)) {
    photon.packet.throughput = SampledSpectrum();
    return result;
  }
  photon.packet = draw_packet(plan.guides.photon_wavelengths, a[2]);
  if (carries_polarisation(plan.scene))
    photon.packet.polarisation = emitted_polarisation(plan.scene.lights[pick.light], start.ray.direction);
  photon.packet.throughput = plan.scene.lights[pick.light].emission(photon.lambda_nm()) * start.factor;
  photon.ray = start.ray;
  enter_light_media(plan, pick.light, photon);
  return result;
}

}  // namespace abbe
