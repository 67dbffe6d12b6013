#include "transport/technique/ghost_lights.h"

#include <array>
#include <cmath>
#include <optional>

#include "scene/lights/emission.h"
#include "scene/polarisation_need.h"
#include "transport/path/dimensions.h"
#include "transport/path/free_path.h"
#include "transport/path/mis_weight.h"
#include "transport/path/polarised_ends.h"
#include "transport/technique/start_matter.h"

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

// With y a point of the lens and a route, drawn together with the density p(y), and w a direction to a light,
// drawn with p(w), a sample of each of N pixels adds
//     [1/N] W_j T L_j cos / (p(y) p(w))
// at the film point x_j of each lane, W being what the camera makes of the flux along w: all lanes share y
// and w, and are balanced alike. Times are those of the whole span in which the film is exposed.
void GhostLights::connect(const Sampler& sampler, const SampledWavelengths& wavelengths, std::uint32_t path,
                          const Deposit& deposit, const ContributionDeposit& apart) {
  if (!any_) return;
  const std::array<float, 4> of_lens = sampler.group(kGhostGroup);
  const std::array<float, 4> of_light = sampler.group(kGhostGroup + 1);
  const float time = of_lens[kTimeNumber];
  const auto from = sample_ghost(scene_.camera, {of_lens[0], of_lens[1]}, time);
  if (!from) return;
  const LightSampleContext place{from->point, from->normal};
  const PowerLightSampler::SampledLight pick = plan_.path_lights.pick(place, of_light[0]);
  const Light& light = scene_.lights[pick.light];
  const auto towards = sample_light(light, scene_.shapes, place, {of_light[1], of_light[2]}, time);
  if (!towards) return;
  const Imath::V3f& wi = towards->wi;
  const Ray ray = ray_at(from->point, wi, time);
  const SampledSpectrum& nm = wavelengths.lambda_nm;
  const auto seen = density(scene_.camera, ray, nm, from->route);
  if (!seen) return;
  Surroundings around;
  if (const MediumStack inside = camera_matter(plan_, from->point, time); !inside.empty())
    around.enter(scene_, inside, nm);
  const auto passed =
      unblocked_transmission(scene_, caster_, way_to(ray, *towards), ray, around, nm, towards->distance);
  if (!passed) return;
  const float weight =
      mis_weight(SampledSpectrum(), from->pdf * pick.probability * towards->pdf, static_cast<float>(kLanes));
  const SampledSpectrum found = emission_from(light, wi, nm) * seen->importance * passed->transmittance *
                                (towards->factor * seen->cos_theta * weight * scale_);
  std::optional<StokesSpectrum> measured;
  if (carries_polarisation_)
    measured =
        polarisation_of_film(scene_, -wi, time, images_of(*seen)).of(polarisation_of_lamp(light, -wi), -wi);
  const FilmPoint at{static_cast<int>(seen->film.x), static_cast<int>(seen->film.y), seen->cos_film, time,
                     images_of(*seen)};
  with_seen(measures_polarisation_, found, pointer_to(measured), [&](const auto& arriving) {
    response_.expose(at, wavelengths, let_through(scene_.shutter, at, arriving),
                     [&](const FilmPoint& pixel, std::span<const double> values) {
                       deposit(path, pixel, values);
                       if (apart) apart(path, pixel, {pick.light, 0}, values);
                     });
  });
}

}  // namespace abbe
