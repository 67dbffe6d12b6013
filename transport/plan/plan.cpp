#include "transport/plan/plan.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "scene/working_range.h"
#include "transport/plan/light_tree.h"
#include "transport/plan/techniques.h"

namespace abbe {
namespace {

// Bounding box of all shapes that are not distant and whose material satisfies `holds`.
template <typename Holds>
Imath::Box3d bounds_where(const Scene& scene, Holds holds) {
  Imath::Box3d box;
  for (const ShapeInstance& shape : scene.shapes)
    if (!shape.distant && holds(scene.materials[shape.material])) box.extendBy(bounds(shape.shape));
  return box;
}

// The sphere through which photons of distant lights are sent: around all refracting and specular shapes, or
// around everything nearby if photons are the only technique.
struct TargetSphere {
  Imath::V3d center{0};
  double radius = 1;
};
TargetSphere distant_target(const Scene& scene, bool light_only) {
  const Imath::Box3d box = light_only ? scene.bounds : bounds_where(scene, [](const Material& m) {
    return lobes(m).delta || encloses_medium(m);
  });
  return box.isEmpty() ? TargetSphere{} : TargetSphere{box.center(), box.size().length() / 2};
}

// Lower bound of the cosine between `axis` and the rays from a distant light to the target. It combines the
// angle of the light's corners, viewed from the center, with that of the sphere, viewed from the light.
double min_cosine(const Imath::Box3d& light_box, const Imath::V3d& axis, const TargetSphere& target) {
  double cosine = 1;
  for (const double x : {light_box.min.x, light_box.max.x})
    for (const double y : {light_box.min.y, light_box.max.y})
      for (const double z : {light_box.min.z, light_box.max.z})
        cosine = std::min(cosine, (target.center - Imath::V3d(x, y, z)).normalized().dot(axis));
  const double sine = std::min(1.0, target.radius / distance_to(light_box, target.center));
  return cosine * std::sqrt(1 - sine * sine) - std::sqrt(std::max(0.0, 1 - cosine * cosine)) * sine;
}

// Distant light as viewed from the scene, whose center is the origin of world space.
struct DistantLight {
  Imath::V3d center;  // Center of the light's bounding box in world space [m].
  double distance;    // Distance of that center from the origin [m].
  double radius;      // Radius of the sphere around the bounding box [m].
};
// Data of a distant light; nothing for a nearby light or one at infinity.
std::optional<DistantLight> distant_light(const Light& light, const Scene& scene) {
  if (light.at_infinity() || !scene.is_distant(light)) return std::nullopt;
  const Imath::Box3d box = bounds_of(light, scene.shapes);
  return DistantLight{box.center(), box.center().length(), box.size().length() / 2};
}

// Guide of a distant light or a light at infinity; nothing for other lights.
std::optional<PhotonGuide> guide_for_distant(const Scene& scene, const Light& light,
                                             const TargetSphere& target) {
  const Imath::V3f center(target.center);
  if (const std::optional<DirectionCone> beam = beam_of(light))
    return PhotonGuide::for_distant_light(-beam->axis, 1 - static_cast<double>(beam->cap), center,
                                          target.radius);
  const auto distant = distant_light(light, scene);
  if (!distant) return std::nullopt;
  const Imath::V3d axis = -distant->center.normalized();
  return PhotonGuide::for_distant_light(
      Imath::V3f(axis), min_cosine(bounds_of(light, scene.shapes), axis, target), center, target.radius);
}

// The target grows with the light's size, without bound as rays become parallel to it.
std::optional<Error> distant_light_error(const Scene& scene, const Light& light, const TargetSphere& target) {
  constexpr double kMinCosine = 0.1;
  const auto distant = distant_light(light, scene);
  if (!distant ||
      min_cosine(bounds_of(light, scene.shapes), -distant->center.normalized(), target) >= kMinCosine)
    return std::nullopt;
  return Error(
      ErrorCode::scene, light.name,
      fmt::format(
          "photons of a distant light must arrive within 84 degrees of one direction, but this light is "
          "{:g} m across at a distance of {:g} m: use --integrator path",
          2 * distant->radius, distant->distance));
}

// Error{scene} for lights in `traced`, a flag per light, whose photons cannot illuminate the scene; nothing
// if all can. Set `light_only` if photons aim at all nearby shapes instead of the refracting and specular
// ones. Photons of distant lights start outside of all shapes that refract them and are sent through the
// nearby shapes. Distant shapes receive none, and a distant medium attenuates none. The precision of large
// shapes is limited to that of floats there.
std::optional<Error> photon_refusal(const Scene& scene, const std::vector<bool>& traced, bool light_only) {
  constexpr double kSmallest = 1e-5;  // radian: smaller shapes may lack caustics
  bool any_distant = false;
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    any_distant =
        any_distant || (traced[i] && (scene.lights[i].at_infinity() || scene.is_distant(scene.lights[i])));
  if (!any_distant) return std::nullopt;
  const TargetSphere target = distant_target(scene, light_only);
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    if (traced[i])
      if (auto refused = distant_light_error(scene, scene.lights[i], target)) return refused;
  for (const ShapeInstance& shape : scene.shapes) {
    const Imath::Box3d box = bounds(shape.shape);
    const double size = box.size().length();
    const Material& material = scene.materials[shape.material];
    const bool relevant = lobes(material).delta || (light_only && shape.light < 0);
    const bool far =
        shape.distant && (relevant || is_boundary(material)) && size > kSmallest * box.center().length();
    const bool large =
        !shape.distant && (relevant || encloses_medium(material)) && size > 2 * scene.far_threshold_m;
    if (far || large)
      return Error(
          ErrorCode::scene, shape.name,
          fmt::format("photons of a distant light cannot illuminate a shape that is {:g} m across, {:g} m "
                      "from the center of the scene, if other shapes are {:g} m from the camera: use "
                      "--integrator path",
                      size, box.center().length(), scene.far_threshold_m / WorkingRange::kGap));
  }
  return std::nullopt;
}

// A grid takes an eighth of a megabyte. If very many lights are traced, only the strongest are guided; the
// others emit unguided.
constexpr std::ptrdiff_t kMaxGuides = 128;

std::vector<BoundingSphere> specular_spheres(const Scene& scene) {
  std::vector<BoundingSphere> spheres;
  for (const ShapeInstance& shape : scene.shapes) {
    if (shape.distant || !lobes(scene.materials[shape.material]).delta) continue;
    const Imath::Box3d box = bounds(shape.shape);
    spheres.push_back({Imath::V3f(box.center()), static_cast<float>(box.size().length() / 2)});
  }
  return spheres;
}

// Guides before training, one per light. `traced_powers` is the power of each light, 0 if it emits no
// photons. Lights without power, and all nearby lights but the 128 strongest, have unguided emission.
// `light_only` is as for `photon_refusal`.
std::vector<PhotonGuide> make_photon_guides(const Scene& scene, const std::vector<double>& traced_powers,
                                            bool light_only) {
  const Imath::Box3d box = bounds_where(scene, [](const Material& m) { return lobes(m).delta; });
  const TargetSphere target = distant_target(scene, light_only);
  std::vector<PhotonGuide> guides(scene.lights.size());
  for (std::size_t i = 0; i < guides.size(); ++i)
    if (traced_powers[i] > 0)
      if (auto guide = guide_for_distant(scene, scene.lights[i], target)) guides[i] = std::move(*guide);
  if (light_only || box.isEmpty() || guides.empty()) return guides;
  const std::vector<BoundingSphere> casters = specular_spheres(scene);
  std::vector<double> strongest(traced_powers);
  const auto weakest = strongest.begin() + std::min<std::ptrdiff_t>(kMaxGuides, std::ssize(strongest)) - 1;
  std::nth_element(strongest.begin(), weakest, strongest.end(), std::greater<>());
  std::ptrdiff_t count = 0;
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    if (traced_powers[i] > 0 && traced_powers[i] >= *weakest && count++ < kMaxGuides) {
      if (scene.lights[i].at_infinity() || scene.is_distant(scene.lights[i])) {
        guides[i].enable_guiding();
        guides[i].stratify(casters);
        continue;
      }
      const Imath::Box3d light_box = bounds_of(scene.lights[i], scene.shapes);
      const std::optional<DirectionCone> cone = cone_at(scene.lights[i], 0);
      guides[i] =
          PhotonGuide(Imath::V3f(light_box.center()), static_cast<float>(light_box.size().length() / 2),
                      Imath::V3f(box.center()), static_cast<float>(box.size().length() / 2),
                      cone ? std::optional(cone->axis) : std::nullopt);
      guides[i].stratify(casters);
    }
  return guides;
}

// Integral of |emission x response|; a response may be negative.
double sensor_integral(const Curve& emission, const Curve& response) {
  const Curve both = product(emission, response);
  std::vector<Knot> knots(both.knots().begin(), both.knots().end());
  for (Knot& knot : knots) knot.value = std::abs(knot.value);
  return Curve(std::move(knots)).integral();
}

bool is_before(const ScaledCurve& a, const ScaledCurve& b) {
  if (&a.base() == &b.base()) return false;
  const auto first = a.base().knots();
  const auto second = b.base().knots();
  return std::lexicographical_compare(
      first.begin(), first.end(), second.begin(), second.end(), [](const Knot& x, const Knot& y) {
        return std::tie(x.wavelength_nm, x.value) < std::tie(y.wavelength_nm, y.value);
      });
}

// True for each light that emits photons.
std::vector<bool> traced_lights(const Scene& scene) {
  std::vector<bool> traced(scene.lights.size(), false);
  const std::vector<Technique> techniques = chosen_techniques(scene);
  if (!starts_at_lights(techniques)) return traced;
  const bool all = techniques.size() == 1;
  const bool with_environment = traits(techniques.back()).traces_environment;
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    traced[i] =
        (with_environment || !scene.lights[i].is_environment()) && (all || scene.features.light_is_traced[i]);
  return traced;
}

// Distance [m] of the nearest surface that a light at a point illuminates: a probe, and the hits of rays
// along the axes. A lower bound prevents it from dominating evenly illuminated surfaces.
double nearest_illuminated(const Scene& scene, const Imath::V3f& light_position) {
  constexpr double kMinDistance = 1e-3;  // fraction of the scene's radius
  const double radius = scene_radius(scene.bounds);
  double nearest = radius;
  if (is_probe(scene.camera))
    nearest = std::min(nearest, (position(scene.camera) - Imath::V3d(light_position)).length());
  for (const Imath::V3f& axis : {Imath::V3f(1, 0, 0), Imath::V3f(0, 1, 0), Imath::V3f(0, 0, 1)})
    for (const Imath::V3f& direction : {axis, -axis})
      if (const auto hit = scene.intersect(ray_at(light_position, direction, 0)))
        nearest = std::min(nearest, static_cast<double>(hit->t));
  return std::max(nearest, kMinDistance * radius);
}

// Radiance at a pixel per emission of a light, to within a few orders of magnitude: the light fills the view,
// or illuminates the nearest surface. For a distant light it is half way between its radiance and what it
// illuminates.
double strength(const Scene& scene, const Light& light) {
  const auto distant = distant_light(light, scene);
  if (const Imath::V3f* at = light_position(light); at != nullptr)
    return std::pow(distant ? distant->distance : nearest_illuminated(scene, *at), -2);
  return distant ? std::min(1.0, distant->radius / distant->distance) : 1;
}

// Film value of a bright pixel, to within a few orders of magnitude, from the strongest light.
double nominal_value(const Scene& scene, std::span<const double> emissions) {
  const Imath::V2f center(static_cast<float>(scene.camera.width) / 2,
                          static_cast<float>(scene.camera.height) / 2);
  const double weight = central_weight(scene.camera, center) * scene.exposure_s * scene.shutter.mean();
  double nominal = 0;
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    nominal = std::max(nominal, emissions[i] * strength(scene, scene.lights[i]));
  return nominal * weight;
}

// Maximum spectral emission of each light that the sensor records, without the response, because a sensor may
// count 1e18 electrons per joule.
std::vector<double> spectral_emissions(const Scene& scene, const Emissions& emissions) {
  std::vector<double> strongest;
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    strongest.push_back(emissions.sensor_emissions[i] > 0 ? mean_emission(scene.lights[i]).max() : 0);
  return strongest;
}

// Error if the exposure is outside the range of floats, with a margin: paths may carry far less and far more
// than a bright pixel.
std::optional<Error> float_range_error(double nominal, const char* unit) {
  constexpr double kFaintest = 1e-32;  // the smallest float is 1e-38
  constexpr double kBrightest = 1e35;  // the largest float is 3e38
  const bool faint = nominal > 0 && nominal < kFaintest;
  if (!faint && !(nominal > kBrightest)) return std::nullopt;
  return Error(
      ErrorCode::scene, "",
      fmt::format("exposure and lights give film values {} the range of floats (got about {:.2g}{} at a "
                  "bright pixel, allowed {:g} to {:g}): change the exposure or the lights",
                  faint ? "below" : "above", nominal, unit, kFaintest, kBrightest));
}

// Fraction of a light's power that arrives at the scene.
double arriving_fraction(const Scene& scene, const Light& light) {
  const auto distant = distant_light(light, scene);
  return distant ? std::min(1.0, std::pow(scene_radius(scene.bounds) / distant->distance, 2)) : 1;
}

std::vector<double> sensor_weighted_powers(const Scene& scene, const Emissions& emissions) {
  std::vector<double> powers;
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    powers.push_back(emissions.sensor_emissions[i] * etendue(scene.lights[i], scene_radius(scene.bounds)) *
                     arriving_fraction(scene, scene.lights[i]));
  return powers;
}

// Lights at a point, whose irradiance varies with the inverse squared distance along scattering segments.
PowerLightSampler equiangular_light_sampler(const Scene& scene, const Emissions& emissions) {
  std::vector<double> powers = sensor_weighted_powers(scene, emissions);
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    if (!scene.features.scattering || light_position(scene.lights[i]) == nullptr) powers[i] = 0;
  return PowerLightSampler(powers);
}

WavelengthDistribution make_wavelengths(const Scene& scene, std::span<const Curve> emissions) {
  std::vector<Curve> responses;
  for (const Channel& channel : scene.channels) responses.push_back(envelope(channel));
  return {emissions, responses};
}

std::vector<WavelengthDistribution> make_channel_wavelengths(const Scene& scene,
                                                             std::span<const Curve> emissions) {
  std::vector<WavelengthDistribution> own;
  if (scene.mosaic && !traits(scene.camera).displaces_wavelengths)
    for (const Channel& channel : scene.channels)
      own.emplace_back(emissions, std::span(&envelope(channel), 1));
  return own;
}

// Lower bound, so that small films are not blurred more than large ones.
constexpr std::uint64_t kMinPhotonsPerSample = 16384;

// Radius that contains one photon if photons are uniform over the ball around the scene.
double first_gather_radius(const Scene& scene, std::uint64_t photons) {
  if (scene.render.photons.radius_m) return *scene.render.photons.radius_m;
  const auto many = static_cast<double>(std::max(photons, kMinPhotonsPerSample));
  return 2 * scene_radius(scene.bounds) / std::sqrt(many);
}

std::uint64_t photons_of(const Scene& scene, std::span<const Technique> techniques) {
  const std::uint64_t pixels =
      static_cast<std::uint64_t>(scene.camera.width) * static_cast<std::uint64_t>(scene.camera.height);
  return scene_sets_photon_count(techniques)
             ? scene.render.photons.per_sample.value_or(std::max(pixels, kMinPhotonsPerSample))
             : pixels;
}

// A lens or probe of finite size may be in several media at once.
bool camera_media_vary(const Scene& scene) {
  const bool extended = traits(scene.camera).opening.has_value();
  return (scene.features.motion || extended) &&
         media_may_change(scene, bounds(scene.camera), scene.camera.motion != nullptr || extended);
}

void find_varying_media(Plan& plan) {
  const Scene& scene = plan.scene;
  for (const Light& light : scene.lights)
    plan.light_media_vary.push_back(
        !light.at_infinity() && !scene.is_distant(light) &&
        media_may_change(scene, bounds_of(light, scene.shapes), motion_of(light, scene.shapes) != nullptr));
}

// True if NEE of camera paths is balanced with emitter hits by BSDF sampling.
bool balances_lights(const Scene& scene, const std::vector<Technique>& techniques) {
  const TracedPaths traced = traits(techniques.front()).traces;
  return traced == TracedPaths::camera ? scene.render.sampling.lights == LightStrategy::mis &&
                                             scene.render.sampling.directions == DirectionSampling::bsdf
                                       : traced == TracedPaths::both;
}

// Makes a plan without the checks of `refusal`.
Plan plan_of(const Scene& scene, std::vector<Technique> techniques, const Emissions& emissions,
             const std::vector<bool>& traced) {
  const bool light_only = techniques.size() == 1;  // if photons are guided
  const bool traces_light = starts_at_lights(techniques);
  const std::vector<Curve> equal_energy{Curve(1.0)};
  const std::span<const Curve> emission_curves =
      traits(techniques.front()).traces == TracedPaths::camera_by_chance ? equal_energy : emissions.distinct;
  const std::uint64_t photons = photons_of(scene, techniques);
  std::vector<double> traced_powers = sensor_weighted_powers(scene, emissions);
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    if (!traced[i]) traced_powers[i] = 0;
  const WavelengthDistribution wavelengths = make_wavelengths(scene, emission_curves);
  const bool guides_photons = traces(techniques, TracedPaths::light);
  Plan plan{
      scene,
      wavelengths,
      LightSampler(scene, emissions.sensor_emissions, balances_lights(scene, techniques)),
      PowerLightSampler(traced_powers),
      traced,
      {guides_photons ? make_photon_guides(scene, traced_powers, light_only) : std::vector<PhotonGuide>(),
       wavelengths},
      std::move(techniques),
      photons,
      1,
      nominal_value(scene, emissions.sensor_emissions),
      make_channel_wavelengths(scene, emission_curves),
      media_at_camera(scene),
      std::vector<MediumStack>(traces_light ? scene.lights.size() : 0)};
  plan.gather_radius = static_cast<float>(first_gather_radius(scene, photons));
  plan.camera_media_vary = camera_media_vary(scene);
  if (scene.features.motion) find_varying_media(plan);
  if (traces(plan.techniques, TracedPaths::camera))
    plan.equiangular_lights = equiangular_light_sampler(scene, emissions);
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    if (traced[i]) plan.light_media[i] = media_at_light(scene, scene.lights[i]).value();
  if (traces_light && plan.traced_lights.empty()) {
    std::erase_if(plan.techniques, [](Technique one) { return traits(one).traces == TracedPaths::light; });
    plan.traced.assign(scene.lights.size(), false);
  }
  return plan;
}

// Error for a light in `traced` from which photons cannot start.
std::optional<Error> photon_start_error(const Scene& scene, const std::vector<bool>& traced) {
  for (std::size_t i = 0; i < traced.size(); ++i)
    if (traced[i] && !media_at_light(scene, scene.lights[i]))
      return Error(ErrorCode::scene, scene.lights[i].name,
                   "photons cannot start from a light that is in two media at once: use --integrator path");
  return std::nullopt;
}

std::optional<Error> refusal_of(const Scene& scene, const Emissions& emissions) {
  if (auto error = float_range_error(nominal_value(scene, emissions.sensor_emissions), "")) return error;
  const double nominal_spectral = nominal_value(scene, spectral_emissions(scene, emissions));
  if (auto error = float_range_error(nominal_spectral, " J/(m^2 nm)")) return error;
  std::vector<bool> traced = traced_lights(scene);
  if (auto refused = photon_start_error(scene, traced)) return refused;
  const bool guides_photons = traces(chosen_techniques(scene), TracedPaths::light);
  for (std::size_t i = 0; i < traced.size(); ++i)
    traced[i] = traced[i] && (guides_photons || scene.lights[i].at_infinity());  // other lights emit unguided
  return photon_refusal(scene, traced, scene.render.integrator != Integrator::automatic);
}

}  // namespace

Emissions emissions_of(const Scene& scene) {
  Emissions emissions;
  std::map<ScaledCurve, double, decltype(&is_before)> known(is_before);  // integral for a factor of 1
  for (const Light& light : scene.lights) {
    const ScaledCurve emission = mean_emission(light);
    const auto [at, is_new] = known.emplace(emission, 0);
    if (is_new) {
      for (const Channel& channel : scene.channels)
        at->second = std::max(at->second, sensor_integral(emission.base(), envelope(channel)));
      emissions.distinct.push_back(emission.base());
    }
    emissions.sensor_emissions.push_back(at->second * emission.factor());
  }
  return emissions;
}

std::uint64_t photons_of_sample(const Scene& scene) {
  return photons_of(scene, chosen_techniques(scene));
}

std::uint64_t paths_to_any_pixel(const Plan& plan) {
  const bool any = starts_at_lights(plan.techniques) || traits(plan.scene.camera).displaces_wavelengths;
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
  if (photon_refusal(scene, lights, false) || photon_start_error(scene, lights)) return std::nullopt;
  Plan plan = plan_of(scene, {kAutomaticPaths, kAutomaticPhotons}, emissions, lights);
  if (plan.traced_lights.empty()) return std::nullopt;
  return plan;
}

}  // namespace abbe
