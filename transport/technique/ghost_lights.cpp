#include "transport/technique/ghost_lights.h"

#include <array>
#include <cmath>
#include <optional>

#include "scene/lights/light.h"
#include "scene/scene_features.h"
#include "transport/path/dimensions.h"
#include "transport/path/free_path.h"
#include "transport/path/mis_weight.h"
#include "transport/path/polarised_paths.h"
#include "transport/technique/path_starts.h"

namespace abbe {

GhostLights::GhostLights(const Plan& plan, RayCaster& caster)
    : plan_(plan),
      scene_(plan.scene),
      caster_(caster),
      any_(traits(plan.scene.camera).ghosts && !plan.path_lights.empty()),
      response_(film_response_of(plan.scene)),
      carries_polarisation_(carries_polarisation(plan.scene)),
      measures_polarisation_(measures_polarisation(plan.scene)),
      scale_(static_cast<float>(plan.scene.exposure_s / plan.scene.camera.width / plan.scene.camera.height)) {
}

// A sample has a point y of the lens and a route, sampled jointly with the pdf p(y), and a direction w to a
// light, sampled with p(w). With one sample for each of N pixels it adds
//     [1/N] W_j T L_j cos / (p(y) p(w))
// at the film point x_j of each wavelength. W is the camera's response to flux along w. All wavelengths have
// the same y and w and equal weights. Times are uniform over the whole exposure.
void GhostLights::connect(const Sampler& sampler, const SampledWavelengths& wavelengths, std::uint32_t path,
                          const Deposit& deposit, const ContributionDeposit& layer_sink) {
  if (!any_) return;
  const std::array<float, 4> lens_random = sampler.group(kGhostGroup);
  const std::array<float, 4> light_random = sampler.group(kGhostGroup + 1);
  const float time = lens_random[kTimeIndex];
  const auto from = sample_ghost(scene_.camera, {lens_random[0], lens_random[1]}, time);
  if (!from) return;
  const LightSampleContext context{from->point, from->normal};
  const PowerLightSampler::SampledLight pick = plan_.path_lights.pick(context, light_random[0]);
  const Light& light = scene_.lights[pick.light];
  const auto towards = sample_light(light, scene_.shapes, context, {light_random[1], light_random[2]}, time);
  if (!towards) return;
  const Imath::V3f& wi = towards->wi;
  const Ray ray = ray_at(from->point, wi, time);
  const SampledSpectrum& nm = wavelengths.lambda_nm;
  const auto camera = density(scene_.camera, ray, nm, from->route);
  if (!camera) return;
  MediumState media;
  if (const MediumStack stack = camera_media(plan_, from->point, time); !stack.empty())
    media.enter(scene_, stack, nm);
  const auto passed =
      unblocked_transmission(scene_, caster_, shadow_ray(ray, *towards), ray, media, nm, towards->distance);
  if (!passed) return;
  const float weight =
      mis_weight(SampledSpectrum(), from->pdf * pick.probability * towards->pdf, static_cast<float>(kLanes));
  const SampledSpectrum contribution = emission_from(light, wi, nm) * camera->importance *
                                       passed->transmittance *
                                       (towards->factor * camera->cos_theta * weight * scale_);
  std::optional<StokesSpectrum> measured;
  if (carries_polarisation_)
    measured =
        polarisation_of_film(scene_, -wi, time, images_of(*camera)).of(emitted_polarisation(light, -wi), -wi);
  const FilmPoint at{static_cast<int>(camera->film.x), static_cast<int>(camera->film.y), camera->cos_film,
                     time, images_of(*camera)};
  with_measurement(measures_polarisation_, contribution, pointer_to(measured), [&](const auto& value) {
    response_.expose(at, wavelengths, apply_shutter(scene_.shutter, at, value),
                     [&](const FilmPoint& pixel, std::span<const double> values) {
                       deposit(path, pixel, values);
                       if (layer_sink) layer_sink(path, pixel, {pick.light, 0}, values);
                     });
  });
}

}  // namespace abbe
