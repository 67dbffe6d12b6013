#include "transport/technique/photon_start.h"

#include <array>
#include <cmath>
#include <numbers>

#include "scene/polarisation_need.h"
#include "scene/shapes/basis.h"
#include "transport/path/dimensions.h"
#include "transport/path/polarised_ends.h"
#include "transport/technique/start_matter.h"

namespace abbe {
namespace {

// How a photon sets out: its power is the light's emission times `factor`, 0 if it gets nowhere.
struct PhotonRay {
  Ray ray;
  float factor = 0;
};

// The random numbers a photon starts by, in [0, 1).
struct PhotonRandom {
  Imath::V2f aim;    // a direction, or a point aimed at
  Imath::V2f start;  // a point of the light, or of a sun
  float choice;      // between target and emission
  float time;        // as rays have it, of all those of the exposure
};

bool shines(const Light& light, const EmissionPoint& from, const Imath::V3f& wi, float time) {
  if (const auto* spot = std::get_if<SpotLight>(&light.kind)) return spot->lights(wi, time);
  return emits_towards(light, from.normal, wi);
}

PhotonRay start_near(const Plan& plan, const PowerLightSampler::SampledLight& pick, const PhotonRandom& u) {
  const Light& light = plan.scene.lights[pick.light];
  const EmissionPoint from = sample_emission_point(light, plan.scene.shapes, u.start, u.time);
  const AimedDirection aimed = plan.guides.aims[pick.light].sample(light, from, u.choice, u.aim, u.time);
  if (!shines(light, from, aimed.wi, u.time)) return {};
  const bool area = light.is<AreaLight>();
  const float cosine = area ? std::abs(from.normal.dot(aimed.wi)) : 1.0F;
  return {area ? spawn(from.point, from.normal, aimed.wi, u.time) : ray_at(from.point, aimed.wi, u.time),
          cosine / (pick.probability * from.pdf_area * aimed.pdf)};
}

// The way through a point of the target, from outside of the sphere it stands for.
Ray arriving(const Aim& aim, const AimedPoint& at, const Imath::V3f& direction, float time) {
  return ray_at(at.point - direction * (2 * aim.half_size()), direction, time);
}

PhotonRay start_far(const Plan& plan, RayCaster& caster, const PowerLightSampler::SampledLight& pick,
                    const PhotonRandom& u) {
  const Light& light = plan.scene.lights[pick.light];
  const Aim& aim = plan.guides.aims[pick.light];
  const EmissionPoint from = sample_emission_point(light, plan.scene.shapes, u.start, u.time);
  const AimedPoint at = aim.point(u.aim);
  const Imath::V3d way = Imath::V3d(at.point) - Imath::V3d(from.point);
  const double distance = way.length();
  const Imath::V3f wi(way * (1 / distance));
  const Ray ray = arriving(aim, at, wi, u.time);
  if (!shines(light, from, wi, u.time)) return {ray};
  const bool area = light.is<AreaLight>();
  if (caster.occluded(
          way_between(ray.origin, area ? offset_point(from.point, from.normal, wi) : from.point, u.time)))
    return {ray};
  const float cosines = (area ? std::abs(from.normal.dot(wi)) : 1.0F) * std::abs(aim.axis().dot(wi));
  const double density = static_cast<double>(pick.probability * from.pdf_area) * static_cast<double>(at.pdf) *
                         distance * distance;
  return {ray, static_cast<float>(static_cast<double>(cosines) / density)};
}

PhotonRay start_at_infinity(const Plan& plan, RayCaster& caster, const PowerLightSampler::SampledLight& pick,
                            const PhotonRandom& u) {
  const Light& light = plan.scene.lights[pick.light];
  const Aim& aim = plan.guides.aims[pick.light];
  const LightSample from = *sample_light(light, plan.scene.shapes, {}, u.start, u.time);
  const AimedPoint at = aim.point(u.aim);
  const Ray ray = arriving(aim, at, -from.wi, u.time);
  if (caster.occluded(way_along(ray_at(ray.origin, from.wi, u.time)))) return {ray};
  const float cosine = std::abs(aim.axis().dot(from.wi));
  return {ray, cosine / (pick.probability * at.pdf * from.pdf)};
}

PhotonRay start_ray(const Plan& plan, RayCaster& caster, const PowerLightSampler::SampledLight& pick,
                    const PhotonRandom& u) {
  const Light& light = plan.scene.lights[pick.light];
  if (light.at_infinity()) return start_at_infinity(plan, caster, pick, u);
  return plan.scene.is_far(light) ? start_far(plan, caster, pick, u) : start_near(plan, pick, u);
}

}  // namespace

PhotonStart start_photon(const Plan& plan, RayCaster& caster, Walk& photon) {
  const std::array<float, 4> a = photon.sampler.group(kAimGroup);
  const std::array<float, 4> b = photon.sampler.group(kEmissionGroup);
  const PowerLightSampler::SampledLight pick = plan.traced_lights.pick(b[3]);
  const PhotonRay start = start_ray(plan, caster, pick, {{a[0], a[1]}, {b[0], b[1]}, b[2], a[kTimeNumber]});
  PhotonStart told{pick.light, start.ray.origin, start.ray.direction};
  if (!(start.factor > 0)) {
    photon.packet.throughput = SampledSpectrum();
    return told;
  }
  photon.packet = draw_packet(plan.guides.photon_wavelengths, a[2]);
  if (carries_polarisation(plan.scene))
    photon.packet.polarisation = polarisation_of_lamp(plan.scene.lights[pick.light], start.ray.direction);
  photon.packet.throughput = plan.scene.lights[pick.light].emission(photon.lambda_nm()) * start.factor;
  photon.ray = start.ray;
  enter_light_matter(plan, pick.light, photon);
  return told;
}

}  // namespace abbe
