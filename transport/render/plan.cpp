#include "transport/render/plan.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "io/error.h"
#include "scene/extent.h"
#include "transport/light/light_tracer.h"

namespace abbe {
namespace {

// Around all shapes that are not far and whose material `holds`, as what photons are aimed at.
template <typename Holds>
Imath::Box3d bounds_where(const Scene& scene, Holds holds) {
  Imath::Box3d box;
  for (const ShapeInstance& shape : scene.shapes)
    if (!shape.far && holds(scene.materials[shape.material])) box.extendBy(bounds(shape.shape));
  return box;
}

Imath::Box3d bounds_of(const Light& light, const Scene& scene) {
  if (const Imath::V3f* at = place(light)) return Imath::Box3d(Imath::V3d(*at));
  return bounds(scene.shapes[std::get<AreaLight>(light.kind).shape].shape);
}

// Of a light that is far: how far it is from the middle of the scene, and how large.
struct FarAway {
  Imath::V3d center;
  double distance;
  double radius;
};
std::optional<FarAway> far_away(const Light& light, const Scene& scene) {
  if (light.at_infinity() || !scene.is_far(light)) return std::nullopt;
  const Imath::Box3d box = bounds_of(light, scene);
  return FarAway{box.center(), box.center().length(), box.size().length() / 2};
}

// What photons from afar are sent through: a sphere around what may bend them, or around all that is near.
struct Target {
  Imath::V3d center{0};
  double radius = 1;
};
Target target_from_afar(const Scene& scene, bool light_only) {
  const Imath::Box3d box = light_only ? scene.bounds : bounds_where(scene, [](const Material& m) {
    return lobes(m).delta || encloses_matter(m);
  });
  return box.isEmpty() ? Target{} : Target{box.center(), box.size().length() / 2};
}

// Of the angle that rays from a far lamp to the target make with `axis` at most: that of the lamp's corners
// as seen from the middle, and of the sphere as seen from the lamp.
double least_cosine(const Imath::Box3d& lamp, const Imath::V3d& axis, const Target& target) {
  double cosine = 1;
  for (const double x : {lamp.min.x, lamp.max.x})
    for (const double y : {lamp.min.y, lamp.max.y})
      for (const double z : {lamp.min.z, lamp.max.z})
        cosine = std::min(cosine, (target.center - Imath::V3d(x, y, z)).normalized().dot(axis));
  const double sine = std::min(1.0, target.radius / distance_to(lamp, target.center));
  return cosine * std::sqrt(1 - sine * sine) - std::sqrt(std::max(0.0, 1 - cosine * cosine)) * sine;
}

// For a light that is far or at infinity; nothing for the others.
std::optional<Aim> aim_from_afar(const Scene& scene, const Light& light, const Target& target) {
  const Imath::V3f center(target.center);
  if (const auto* beam = std::get_if<DirectionalLight>(&light.kind))
    return Aim::from_afar(-beam->towards, 1, center, target.radius);
  if (const auto* sun = std::get_if<SunLight>(&light.kind))
    return Aim::from_afar(-sun->towards, 1 - static_cast<double>(sun->cap), center, target.radius);
  const auto lamp = far_away(light, scene);
  if (!lamp) return std::nullopt;
  const Imath::V3d axis = -lamp->center.normalized();
  return Aim::from_afar(Imath::V3f(axis), least_cosine(bounds_of(light, scene), axis, target), center,
                        target.radius);
}

// The target grows with a lamp's size, and has an end where rays run along it.
std::optional<Error> refusal_of_lamp(const Scene& scene, const Light& light, const Target& target) {
  constexpr double kLeastCosine = 0.1;
  const auto lamp = far_away(light, scene);
  if (!lamp || least_cosine(bounds_of(light, scene), -lamp->center.normalized(), target) >= kLeastCosine)
    return std::nullopt;
  return Error(
      ErrorCode::scene, light.name,
      fmt::format("photons of a lamp from afar come within 84 degrees of one direction: it is {:g} m "
                  "across and {:g} m away; --integrator path renders it",
                  2 * lamp->radius, lamp->distance));
}

// Photons from afar are sent through what is near, so that they meet nothing that is far, nor lose anything
// in a cloud there; and they start outside of all that may bend them, so that they are no finer than floats
// there.
std::optional<Error> refusal(const Scene& scene, const std::vector<bool>& traced, bool light_only) {
  constexpr double kSmallest = 1e-5;  // of a radian: less of the view than this may go without caustics
  bool from_afar = false;
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    from_afar = from_afar || (traced[i] && (scene.lights[i].at_infinity() || scene.is_far(scene.lights[i])));
  if (!from_afar) return std::nullopt;
  const Target target = target_from_afar(scene, light_only);
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    if (traced[i])
      if (auto refused = refusal_of_lamp(scene, scene.lights[i], target)) return refused;
  for (const ShapeInstance& shape : scene.shapes) {
    const Imath::Box3d box = bounds(shape.shape);
    const double size = box.size().length();
    const Material& material = scene.materials[shape.material];
    const bool met = lobes(material).delta || (light_only && shape.light < 0);
    const bool far = shape.far && (met || is_boundary(material)) && size > kSmallest * box.center().length();
    const bool large = !shape.far && (met || encloses_matter(material)) && size > 2 * scene.far_from_m;
    if (far || large)
      return Error(ErrorCode::scene, shape.name,
                   fmt::format("photons of a light from afar cannot light a shape {:g} m across, {:g} m from "
                               "the middle of the scene, beside what is {:g} m from the camera: --integrator "
                               "path renders it",
                               size, box.center().length(), scene.far_from_m / Extent::kGap));
  }
  return std::nullopt;
}

// Per light, whether photons start there at all.
std::vector<bool> traced_lights(const Scene& scene) {
  std::vector<bool> traced(scene.lights.size(), false);
  if (!traces_light(scene)) return traced;
  const bool light_only = scene.render.integrator == Integrator::light;
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    traced[i] = !scene.lights[i].is_environment() && (light_only || scene.needs.light_is_traced[i]);
  return traced;
}

// Aims cost half a megabyte each, so that of very many traced lights only the strongest have one; the others
// shine everywhere.
constexpr std::ptrdiff_t kMostAims = 128;

std::vector<Aim> make_aims(const Scene& scene, const std::vector<double>& traced_powers, bool light_only) {
  const Imath::Box3d box = bounds_where(scene, [](const Material& m) { return lobes(m).delta; });
  const Target target = target_from_afar(scene, light_only);
  std::vector<Aim> aims(scene.lights.size());
  for (std::size_t i = 0; i < aims.size(); ++i)
    if (traced_powers[i] > 0)
      if (auto aim = aim_from_afar(scene, scene.lights[i], target)) aims[i] = std::move(*aim);
  if (light_only || box.isEmpty() || aims.empty()) return aims;
  std::vector<double> strongest(traced_powers);
  const auto least = strongest.begin() + std::min<std::ptrdiff_t>(kMostAims, std::ssize(strongest)) - 1;
  std::nth_element(strongest.begin(), least, strongest.end(), std::greater<>());
  std::ptrdiff_t count = 0;
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    if (traced_powers[i] > 0 && traced_powers[i] >= *least && count++ < kMostAims) {
      if (scene.lights[i].at_infinity() || scene.is_far(scene.lights[i]))
        aims[i].guide();
      else
        aims[i] = Aim(Imath::V3f(bounds_of(scene.lights[i], scene).center()), Imath::V3f(box.center()),
                      static_cast<float>(box.size().length() / 2));
    }
  return aims;
}

// Integral of |emission x response|: a response may be negative.
double weighed(const Curve& emission, const Curve& response) {
  const Curve both = product(emission, response);
  std::vector<Knot> knots(both.knots().begin(), both.knots().end());
  for (Knot& knot : knots) knot.value = std::abs(knot.value);
  return Curve(std::move(knots)).integral();
}

bool comes_before(const ScaledCurve& a, const ScaledCurve& b) {
  if (&a.base() == &b.base()) return false;
  const auto first = a.base().knots();
  const auto second = b.base().knots();
  return std::lexicographical_compare(
      first.begin(), first.end(), second.begin(), second.end(), [](const Knot& x, const Knot& y) {
        return std::tie(x.wavelength_nm, x.value) < std::tie(y.wavelength_nm, y.value);
      });
}

// The mean emissions of the lights, proportional ones once, so that many lamps of one kind cost what one
// costs and starve no other kind of wavelengths; and how strongly the sensor sees each light, its largest
// channel.
struct Emissions {
  std::vector<Curve> distinct;
  std::vector<double> seen;
};

Emissions emissions_of(const Scene& scene) {
  Emissions emissions;
  std::map<ScaledCurve, double, decltype(&comes_before)> known(comes_before);  // seen for a factor of 1
  for (const Light& light : scene.lights) {
    const ScaledCurve emission = mean_emission(light);
    const auto [at, is_new] = known.emplace(emission, 0);
    if (is_new) {
      for (const Channel& channel : scene.channels)
        at->second = std::max(at->second, weighed(emission.base(), reach(channel)));
      emissions.distinct.push_back(emission.base());
    }
    emissions.seen.push_back(at->second * emission.factor());
  }
  return emissions;
}

// What a pixel sees of a light, over its emission, to within a few orders of magnitude: the light fills the
// view, or shines from a scene's size away. Of a far lamp that is half way between its radiance and what it
// lights.
double strength(const Scene& scene, const Light& light) {
  const auto lamp = far_away(light, scene);
  if (place(light) != nullptr) return std::pow(lamp ? lamp->distance : scene_radius(scene.bounds), -2);
  return lamp ? std::min(1.0, lamp->radius / lamp->distance) : 1;
}

// A bright pixel's value to within a few orders of magnitude, of the strongest light.
double nominal_value(const Scene& scene, const Emissions& emissions) {
  const Imath::V2f center(static_cast<float>(scene.camera.width) / 2,
                          static_cast<float>(scene.camera.height) / 2);
  const double weight =
      static_cast<double>(sample_ray(scene.camera, center, {0.5F, 0.5F}).weight) * scene.exposure_s;
  double nominal = 0;
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    nominal = std::max(nominal, emissions.seen[i] * strength(scene, scene.lights[i]));
  return nominal * weight;
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

WavelengthDistribution make_wavelengths(const Scene& scene, const Emissions& emissions) {
  std::vector<Curve> responses;
  for (const Channel& channel : scene.channels) responses.push_back(reach(channel));
  return {emissions.distinct, responses};
}

std::vector<WavelengthDistribution> make_own_wavelengths(const Scene& scene, const Emissions& emissions) {
  std::vector<WavelengthDistribution> own;
  if (scene.mosaic)
    for (const Channel& channel : scene.channels)
      own.emplace_back(emissions.distinct, std::span(&reach(channel), 1));
  return own;
}

}  // namespace

LightPicker::LightPicker(const std::vector<double>& weights) : probability_(weights.size(), 0.0F) {
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  if (!(total > 0)) return;
  const auto positive =
      static_cast<double>(std::count_if(weights.begin(), weights.end(), [](double w) { return w > 0; }));
  double sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double p = weights[i] > 0 ? 0.9 * weights[i] / total + 0.1 / positive : 0;
    probability_[i] = static_cast<float>(p);
    sum += p;
    cdf_.push_back(static_cast<float>(sum));
  }
}

LightPicker::Pick LightPicker::pick(float u) const {
  auto i = static_cast<std::uint32_t>(std::upper_bound(cdf_.begin(), cdf_.end(), u) - cdf_.begin());
  i = std::min(i, static_cast<std::uint32_t>(cdf_.size()) - 1);
  while (probability_[i] == 0.0F) --i;  // u beyond a sum rounded below 1
  return {i, probability_[i]};
}

bool traces_light(const Scene& scene) {
  return scene.render.integrator == Integrator::light ||
         (scene.render.integrator == Integrator::automatic && scene.needs.light_tracing);
}

std::optional<Error> refusal(const Scene& scene) {
  return refusal(scene, traced_lights(scene), scene.render.integrator == Integrator::light);
}

Plan make_plan(const Scene& scene, int threads) {
  return make_plan(scene, threads, scene.render.seed);
}

Plan make_plan(const Scene& scene, int threads, std::uint64_t seed) {
  const bool light_only = scene.render.integrator == Integrator::light;
  const bool light_active = traces_light(scene);
  const Emissions emissions = emissions_of(scene);
  const std::vector<double> powers = sensor_weighted_powers(scene, emissions);
  const std::vector<bool> traced = traced_lights(scene);
  std::vector<double> traced_powers(scene.lights.size(), 0.0);
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    if (traced[i]) traced_powers[i] = powers[i];
  if (const std::optional<Error> refused = refusal(scene, traced, light_only)) throw Error(*refused);
  Plan plan{scene,
            make_wavelengths(scene, emissions),
            LightPicker(powers),
            LightPicker(traced_powers),
            traced,
            light_active ? make_aims(scene, traced_powers, light_only) : std::vector<Aim>(),
            !light_only,
            light_active,
            light_only,
            nominal_value(scene, emissions),
            make_own_wavelengths(scene, emissions),
            around_camera(scene),
            std::vector<Enclosures>(light_active ? scene.lights.size() : 0)};
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    if (traced[i]) plan.light_inside[i] = around_light(scene, scene.lights[i]);
  plan.light_active = light_active && !plan.traced_lights.empty();
  if (!plan.light_active) plan.traced.assign(scene.lights.size(), false);
  if (plan.light_active && !light_only) learn_aims(plan, seed, threads);
  return plan;
}

}  // namespace abbe
