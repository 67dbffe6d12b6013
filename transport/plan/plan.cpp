#include "transport/plan/plan.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "scene/extent.h"
#include "transport/plan/aiming.h"
#include "transport/plan/emissions.h"
#include "transport/plan/light_bounds.h"
#include "transport/plan/photon_settings.h"

namespace abbe {
namespace {

// Per light, whether photons start there at all.
std::vector<bool> traced_lights(const Scene& scene) {
  std::vector<bool> traced(scene.lights.size(), false);
  const std::vector<Technique> techniques = chosen_techniques(scene);
  if (!starts_at_lights(techniques)) return traced;
  const bool all = !uses(techniques, Technique::path);
  const bool with_sky = !uses(techniques, Technique::light) && !uses(techniques, Technique::bdpt);
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    traced[i] = (with_sky || !scene.lights[i].is_environment()) && (all || scene.needs.light_is_traced[i]);
  return traced;
}

// How far [m] the nearest of what a lamp at a point lights is: a meter, and what rays along the axes meet;
// not so near that what is lit evenly would be lost beside it.
double nearest_lit(const Scene& scene, const Imath::V3f& lamp) {
  constexpr double kLeast = 1e-3;  // of the scene's radius
  const double radius = scene_radius(scene.bounds);
  double nearest = radius;
  if (is_meter(scene.camera))
    nearest = std::min(nearest, (position(scene.camera) - Imath::V3d(lamp)).length());
  for (const Imath::V3f& axis : {Imath::V3f(1, 0, 0), Imath::V3f(0, 1, 0), Imath::V3f(0, 0, 1)})
    for (const Imath::V3f& direction : {axis, -axis})
      if (const auto hit = scene.intersect(ray_at(lamp, direction, 0)))
        nearest = std::min(nearest, static_cast<double>(hit->t));
  return std::max(nearest, kLeast * radius);
}

// What a pixel sees of a light, over its emission, to within a few orders of magnitude: the light fills the
// view, or shines on what is nearest to it. Of a far lamp that is half way between its radiance and what it
// lights.
double strength(const Scene& scene, const Light& light) {
  const auto lamp = far_away(light, scene);
  if (const Imath::V3f* at = place(light); at != nullptr)
    return std::pow(lamp ? lamp->distance : nearest_lit(scene, *at), -2);
  return lamp ? std::min(1.0, lamp->radius / lamp->distance) : 1;
}

// What lights of these emissions give a bright pixel, to within a few orders of magnitude: the strongest.
double nominal_value(const Scene& scene, std::span<const double> emissions) {
  const Imath::V2f center(static_cast<float>(scene.camera.width) / 2,
                          static_cast<float>(scene.camera.height) / 2);
  const double weight = central_weight(scene.camera, center) * scene.exposure_s * scene.shutter.mean();
  double nominal = 0;
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    nominal = std::max(nominal, emissions[i] * strength(scene, scene.lights[i]));
  return nominal * weight;
}

// The strongest spectral emission of each light that the sensor sees, of which paths carry a part: without
// the response, by which a sensor may count 1e18 electrons for a joule.
std::vector<double> spectral_emissions(const Scene& scene, const Emissions& emissions) {
  std::vector<double> strongest;
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    strongest.push_back(emissions.seen[i] > 0 ? mean_emission(scene.lights[i]).max() : 0);
  return strongest;
}

// Why floats cannot hold so weak or strong an exposure: what paths carry may be far less than a bright one
// has, and far more.
std::optional<Error> beyond_floats(double nominal, const char* unit) {
  constexpr double kFaintest = 1e-32;  // a float's least is 1e-38,
  constexpr double kBrightest = 1e35;  // its greatest 3e38
  const bool faint = nominal > 0 && nominal < kFaintest;
  if (!faint && !(nominal > kBrightest)) return std::nullopt;
  return Error(
      ErrorCode::scene, "",
      fmt::format("exposure and lights give the film {} (got about {:.2g}{} where it is bright, allowed "
                  "{:g} to {:g})",
                  faint ? "less than floats can tell from nothing" : "more than floats can hold", nominal,
                  unit, kFaintest, kBrightest));
}

// The share of a light's power that comes to the scene.
double arriving_share(const Scene& scene, const Light& light) {
  const auto lamp = far_away(light, scene);
  return lamp ? std::min(1.0, std::pow(scene_radius(scene.bounds) / lamp->distance, 2)) : 1;
}

std::vector<double> sensor_weighted_powers(const Scene& scene, const Emissions& emissions) {
  std::vector<double> powers;
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    powers.push_back(emissions.seen[i] * etendue(scene.lights[i], scene_radius(scene.bounds)) *
                     arriving_share(scene, scene.lights[i]));
  return powers;
}

// Lamps at points, whose light falls off with the square of the distance wherever it is scattered.
PowerLightSampler lamps_along_matter(const Scene& scene, const Emissions& emissions) {
  std::vector<double> powers = sensor_weighted_powers(scene, emissions);
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    if (!scene.needs.scattering || !scene.lights[i].is<PointLight, SpotLight>()) powers[i] = 0;
  return PowerLightSampler(powers);
}

WavelengthDistribution make_wavelengths(const Scene& scene, std::span<const Curve> emissions) {
  std::vector<Curve> responses;
  for (const Channel& channel : scene.channels) responses.push_back(envelope(channel));
  return {emissions, responses};
}

std::vector<WavelengthDistribution> make_own_wavelengths(const Scene& scene,
                                                         std::span<const Curve> emissions) {
  std::vector<WavelengthDistribution> own;
  if (scene.mosaic && !traits(scene.camera).displaces_lanes)
    for (const Channel& channel : scene.channels)
      own.emplace_back(emissions, std::span(&envelope(channel), 1));
  return own;
}

// Of a sample where they are gathered, so that small films are not blurred more than large ones.
constexpr std::uint64_t kLeastPhotonsPerSample = 16384;

// Such that one photon would lie within, were they spread evenly over the ball around the scene.
double first_gather_radius(const Scene& scene, std::uint64_t photons) {
  if (scene.render.photons.radius_m) return *scene.render.photons.radius_m;
  const auto many = static_cast<double>(std::max(photons, kLeastPhotonsPerSample));
  return 2 * scene_radius(scene.bounds) / std::sqrt(many);
}

std::uint64_t photons_of(const Scene& scene, std::span<const Technique> techniques) {
  const std::uint64_t pixels =
      static_cast<std::uint64_t>(scene.camera.width) * static_cast<std::uint64_t>(scene.camera.height);
  return traces_photons_alone(techniques)
             ? scene.render.photons.per_sample.value_or(std::max(pixels, kLeastPhotonsPerSample))
             : pixels;
}

// A lens, as a meter of some size, may stand in several kinds of matter at once.
bool camera_matter_varies(const Scene& scene) {
  const bool extended = traits(scene.camera).opening.has_value();
  return (scene.needs.motion || extended) &&
         matter_moves(scene, bounds(scene.camera), scene.camera.motion != nullptr || extended);
}

void look_for_moving_matter(Plan& plan) {
  const Scene& scene = plan.scene;
  for (const Light& light : scene.lights)
    plan.light_matter_moves.push_back(
        !light.at_infinity() && !scene.is_far(light) &&
        matter_moves(scene, bounds_of(light, scene), motion_of(light, scene.shapes) != nullptr));
}

// Whether light that camera paths are connected to is balanced with what they find by the model's scattering.
bool balances_lights(const Scene& scene, const std::vector<Technique>& techniques) {
  return uses(techniques, Technique::path)
             ? scene.render.sampling.lights == LightStrategy::mis &&
                   scene.render.sampling.directions == DirectionSampling::bsdf
             : uses(techniques, Technique::bdpt) || uses(techniques, Technique::vcm);
}

// Nothing being known of `refusal`.
Plan plan_of(const Scene& scene, std::vector<Technique> techniques, const Emissions& emissions,
             const std::vector<bool>& traced) {
  const bool light_only = techniques == std::vector{Technique::light};
  const bool traces_light = starts_at_lights(techniques);
  const std::vector<Curve> equal_energy{Curve(1.0)};
  const std::span<const Curve> seen =
      uses(techniques, Technique::adjoint_brute) ? equal_energy : emissions.distinct;
  const std::uint64_t photons = photons_of(scene, techniques);
  std::vector<double> traced_powers = sensor_weighted_powers(scene, emissions);
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    if (!traced[i]) traced_powers[i] = 0;
  const WavelengthDistribution wavelengths = make_wavelengths(scene, seen);
  const bool aims = uses(techniques, Technique::light);
  Plan plan{scene,
            wavelengths,
            LightSampler(scene, emissions.seen, balances_lights(scene, techniques)),
            PowerLightSampler(traced_powers),
            traced,
            {aims ? make_aims(scene, traced_powers, light_only) : std::vector<Aim>(), wavelengths},
            std::move(techniques),
            photons,
            1,
            nominal_value(scene, emissions.seen),
            make_own_wavelengths(scene, seen),
            around_camera(scene),
            std::vector<MediumStack>(traces_light ? scene.lights.size() : 0)};
  plan.gather_radius = static_cast<float>(first_gather_radius(scene, photons));
  plan.camera_matter_varies = camera_matter_varies(scene);
  if (scene.needs.motion) look_for_moving_matter(plan);
  if (uses(plan.techniques, Technique::path)) plan.lights_along = lamps_along_matter(scene, emissions);
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    if (traced[i]) plan.light_inside[i] = around_light(scene, scene.lights[i]).value();
  if (traces_light && plan.traced_lights.empty()) {
    std::erase(plan.techniques, Technique::light);
    plan.traced.assign(scene.lights.size(), false);
  }
  return plan;
}

// Why photons cannot start from one of these lights.
std::optional<Error> refusal_to_start(const Scene& scene, const std::vector<bool>& traced) {
  for (std::size_t i = 0; i < traced.size(); ++i)
    if (traced[i] && !around_light(scene, scene.lights[i]))
      return Error(ErrorCode::scene, scene.lights[i].name,
                   "photons cannot start from a lamp that stands in two kinds of matter at once: "
                   "--integrator path renders it");
  return std::nullopt;
}

std::optional<Error> refusal_of(const Scene& scene, const Emissions& emissions) {
  if (auto beyond = beyond_floats(nominal_value(scene, emissions.seen), "")) return beyond;
  const double carried = nominal_value(scene, spectral_emissions(scene, emissions));
  if (auto beyond = beyond_floats(carried, " J/m^2 and nm")) return beyond;
  std::vector<bool> traced = traced_lights(scene);
  if (auto refused = refusal_to_start(scene, traced)) return refused;
  const bool aims = uses(chosen_techniques(scene), Technique::light);
  for (std::size_t i = 0; i < traced.size(); ++i)
    traced[i] = traced[i] && (aims || scene.lights[i].at_infinity());  // others shine everywhere
  return refusal(scene, traced, scene.render.integrator != Integrator::automatic);
}

}  // namespace

std::uint64_t photons_of_sample(const Scene& scene) {
  return photons_of(scene, chosen_techniques(scene));
}

std::uint64_t paths_to_any_pixel(const Plan& plan) {
  const bool any = starts_at_lights(plan.techniques) || traits(plan.scene.camera).displaces_lanes;
  return any ? plan.photons : 0;
}

std::optional<Error> refusal(const Scene& scene) {
  return refusal_of(scene, emissions_of(scene));
}

Plan make_plan(const Scene& scene) {
  const Emissions emissions = emissions_of(scene);
  if (const std::optional<Error> refused = refusal_of(scene, emissions)) throw Error(*refused);
  return plan_of(scene, chosen_techniques(scene), emissions, traced_lights(scene));
}

std::optional<Plan> make_photon_plan(const Scene& scene, const Emissions& emissions,
                                     const std::vector<bool>& lights) {
  if (refusal(scene, lights, false) || refusal_to_start(scene, lights)) return std::nullopt;
  Plan plan = plan_of(scene, {Technique::path, Technique::light}, emissions, lights);
  if (plan.traced_lights.empty()) return std::nullopt;
  return plan;
}

}  // namespace abbe
