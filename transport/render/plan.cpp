#include "transport/render/plan.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "transport/light/light_tracer.h"

namespace abbe {
namespace {

double scene_radius(const Scene& scene) {
  return scene.bounds.isEmpty() ? 1.0 : std::max(scene.bounds.size().length() / 2, 1e-12);
}

// The sphere around all specular shapes, as what photons are aimed at.
Imath::Box3d specular_bounds(const Scene& scene) {
  Imath::Box3d box;
  for (const ShapeInstance& shape : scene.shapes)
    if (lobes(scene.materials[shape.material]).delta) box.extendBy(bounds(shape.shape));
  return box;
}

Imath::V3f center_of(const Light& light, const Scene& scene) {
  if (const auto* point = std::get_if<PointLight>(&light.kind)) return point->position;
  if (const auto* spot = std::get_if<SpotLight>(&light.kind)) return spot->position;
  const auto& area = std::get<AreaLight>(light.kind);
  return Imath::V3f(bounds(scene.shapes[area.shape].shape).center());
}

// Aims cost half a megabyte each, so that of very many traced lights only the strongest have one; the others
// shine everywhere.
constexpr std::ptrdiff_t kMostAims = 128;

std::vector<Aim> make_aims(const Scene& scene, const std::vector<double>& traced_powers, bool light_only) {
  const Imath::Box3d box = specular_bounds(scene);
  std::vector<Aim> aims(scene.lights.size());
  if (light_only || box.isEmpty() || aims.empty()) return aims;
  std::vector<double> strongest(traced_powers);
  const auto least = strongest.begin() + std::min<std::ptrdiff_t>(kMostAims, std::ssize(strongest)) - 1;
  std::nth_element(strongest.begin(), least, strongest.end(), std::greater<>());
  std::ptrdiff_t count = 0;
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    if (traced_powers[i] > 0 && traced_powers[i] >= *least && count++ < kMostAims)
      aims[i] = Aim(center_of(scene.lights[i], scene), Imath::V3f(box.center()),
                    static_cast<float>(box.size().length() / 2));
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

// A bright pixel's value to within a few orders of magnitude: the strongest light filling the view, or
// shining from a scene's size away.
double nominal_value(const Scene& scene, const Emissions& emissions) {
  const Imath::V2f center(static_cast<float>(scene.camera.width) / 2,
                          static_cast<float>(scene.camera.height) / 2);
  const double weight =
      static_cast<double>(sample_ray(scene.camera, center, {0.5F, 0.5F}).weight) * scene.exposure_s;
  const double radius = scene_radius(scene);
  double nominal = 0;
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    nominal = std::max(nominal, emissions.seen[i] / (scene.lights[i].is_delta() ? radius * radius : 1));
  return nominal * weight;
}

std::vector<double> sensor_weighted_powers(const Scene& scene, const Emissions& emissions) {
  std::vector<double> powers;
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    powers.push_back(emissions.seen[i] * etendue(scene.lights[i], scene_radius(scene)));
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

Plan make_plan(const Scene& scene, int threads) {
  const bool light_only = scene.render.integrator == Integrator::light;
  const bool light_active = traces_light(scene);
  const Emissions emissions = emissions_of(scene);
  const std::vector<double> powers = sensor_weighted_powers(scene, emissions);
  std::vector<bool> traced(scene.lights.size(), false);
  std::vector<double> traced_powers(scene.lights.size(), 0.0);
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    traced[i] =
        light_active && !scene.lights[i].is_environment() && (light_only || scene.needs.light_is_traced[i]);
    if (traced[i]) traced_powers[i] = powers[i];
  }
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
  if (plan.light_active && !light_only) learn_aims(plan, scene.render.seed, threads);
  return plan;
}

}  // namespace abbe
