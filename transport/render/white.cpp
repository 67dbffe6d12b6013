#include "transport/render/white.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include <fmt/format.h>

#include "scene/colors.h"
#include "scene/extent.h"
#include "sensor/response/stokes_channels.h"
#include "transport/path/film_response.h"
#include "transport/render/learnt_plan.h"
#include "transport/render/pilot.h"

namespace abbe {
namespace {

// Lights whose spectra are proportional: the strongest of them, and its spectrum.
struct Group {
  std::uint32_t light;
  double strength;
  ScaledCurve spectrum;
};

// Most share their curve; those of environment images do not.
bool is_proportional(const ScaledCurve& a, const ScaledCurve& b) {
  constexpr double kRounding = 1e-9;
  if (&a.base() == &b.base()) return true;
  const auto x = a.base().knots();
  const auto y = b.base().knots();
  const double unit_a = a.base().max();
  const double unit_b = b.base().max();
  return std::equal(x.begin(), x.end(), y.begin(), y.end(), [&](const Knot& p, const Knot& q) {
    return p.wavelength_nm == q.wavelength_nm && std::abs(p.value / unit_a - q.value / unit_b) <= kRounding;
  });
}

// By strength, then by what does not depend on the order of the lights.
bool is_stronger(const Scene& scene, const Group& a, const Group& b) {
  return std::tie(b.strength, scene.lights[a.light].name) < std::tie(a.strength, scene.lights[b.light].name);
}

// Lights that emit nothing belong to the first group, where they change nothing.
std::vector<Group> groups_of(const Scene& scene, std::vector<std::uint32_t>& group_of_light) {
  std::vector<Group> groups;
  const double radius = scene_radius(scene.bounds);
  for (std::uint32_t i = 0; i < scene.lights.size(); ++i) {
    ScaledCurve spectrum = mean_emission(scene.lights[i]);
    group_of_light.push_back(0);
    if (!(spectrum.max() > 0)) continue;
    const double strength = spectrum.factor() * spectrum.base().integral() * etendue(scene.lights[i], radius);
    const auto found = std::find_if(groups.begin(), groups.end(), [&](const Group& group) {
      return is_proportional(group.spectrum, spectrum);
    });
    group_of_light.back() = static_cast<std::uint32_t>(found - groups.begin());
    Group here{i, strength, std::move(spectrum)};
    if (found == groups.end())
      groups.push_back(std::move(here));
    else if (is_stronger(scene, here, *found))
      *found = std::move(here);
  }
  return groups;
}

// What a film value of each channel weighs.
std::vector<double> channel_weights(const Scene& scene) {
  if (scene.mosaic) return {1};
  const std::vector<Channel> counting = intensities(scene.channels);
  std::vector<double> weights(counting.size(), 1.0);
  if (standard_observer(counting)) weights = {0, 1, 0};
  if (scene.spectral)
    for (std::size_t k = 0; k < counting.size(); ++k)
      weights[k] = photometric(counting[k].weight) / counting[k].weight.integral();
  weights.resize(scene.channels.size(), 0.0);
  return weights;
}

}  // namespace

White main_light(const Scene& scene, int threads, const std::shared_ptr<const Guides>& guides) {
  ExposureByLight sums{{}, channel_weights(scene), {}};
  const std::vector<Group> groups = groups_of(scene, sums.group);
  const FilmObserver film_observer = film_observer_of(scene);
  if (groups.empty()) return {"E", "there is no light", chromaticity(Curve(1.0), film_observer), Curve(1.0)};
  const auto white = [&](const Group& group, std::string reason) {
    return white_of(scene.lights[group.light], film_observer, std::move(reason));
  };
  if (groups.size() == 1)
    return white(groups.front(), scene.lights.size() == 1 ? "the only light" : "the only spectrum of light");
  sums.exposure.assign(groups.size(), 0.0);
  const bool refused = refusal(scene).has_value();
  if (!refused) pilot_exposures(make_learnt_plan(scene, threads, guides), threads, sums);
  std::size_t most = 0;
  for (std::size_t i = 1; i < groups.size(); ++i)
    if (sums.exposure[i] > sums.exposure[most] ||
        (sums.exposure[i] == sums.exposure[most] && is_stronger(scene, groups[i], groups[most])))
      most = i;
  const double total = std::accumulate(sums.exposure.begin(), sums.exposure.end(), 0.0);
  if (total > 0)
    return white(groups[most],
                 fmt::format("gives the film {:.3g} % of its light", 100 * sums.exposure[most] / total));
  return white(groups[most], refused ? "is the strongest; no pilot can tell"
                                     : "is the strongest; none reached the film in a pilot");
}

White white_of(const Scene& scene, int threads, const std::shared_ptr<const Guides>& guides) {
  if (!scene.output.white) return main_light(scene, threads, guides);
  White white = *scene.output.white;
  if (!white.spectrum) white.spectrum = main_light(scene, threads, guides).spectrum;
  return white;
}

}  // namespace abbe
