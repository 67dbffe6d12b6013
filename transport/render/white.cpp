#include "transport/render/white.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include <fmt/format.h>

#include "scene/white.h"
#include "scene/working_range.h"
#include "sensor/response/polarised_channels.h"
#include "transport/path/film_response.h"
#include "transport/render/pilot.h"
#include "transport/render/trained_plan.h"

namespace abbe {
namespace {

// Group of lights whose spectra are proportional: the strongest of them, and its spectrum.
struct Group {
  std::uint32_t light;
  double strength;
  ScaledCurve spectrum;
};

// True if two spectra are proportional. Most lights refer to one curve; environment images have their own.
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

// Order by strength, then by name, which does not depend on the order of the lights.
bool is_stronger(const Scene& scene, const Group& a, const Group& b) {
  return std::tie(b.strength, scene.lights[a.light].name) < std::tie(a.strength, scene.lights[b.light].name);
}

// Groups of the lights, and the group of each light. Lights that emit nothing belong to the first group,
// where they change nothing.
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
    Group candidate{i, strength, std::move(spectrum)};
    if (found == groups.end())
      groups.push_back(std::move(candidate));
    else if (is_stronger(scene, candidate, *found))
      *found = std::move(candidate);
  }
  return groups;
}

// Weight of a film value of each channel.
std::vector<double> channel_weights(const Scene& scene) {
  if (scene.mosaic) return {1};
  const std::vector<Channel> intensity_channels = intensities(scene.channels);
  std::vector<double> weights(intensity_channels.size(), 1.0);
  if (standard_observer(intensity_channels)) weights = {0, 1, 0};
  if (scene.spectral)
    for (std::size_t k = 0; k < intensity_channels.size(); ++k)
      weights[k] = photometric(intensity_channels[k].weight) / intensity_channels[k].weight.integral();
  weights.resize(scene.channels.size(), 0.0);
  return weights;
}

}  // namespace

White main_light(const Scene& scene, int threads, const std::shared_ptr<const GuidingData>& guides) {
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
  if (!refused) pilot_exposures(make_trained_plan(scene, threads, guides), threads, sums);
  std::size_t strongest = 0;
  for (std::size_t i = 1; i < groups.size(); ++i)
    if (sums.exposure[i] > sums.exposure[strongest] ||
        (sums.exposure[i] == sums.exposure[strongest] && is_stronger(scene, groups[i], groups[strongest])))
      strongest = i;
  const double total = std::accumulate(sums.exposure.begin(), sums.exposure.end(), 0.0);
  if (total > 0)
    return white(groups[strongest],
                 fmt::format("gives the film {:.3g} % of its light", 100 * sums.exposure[strongest] / total));
  return white(groups[strongest], refused ? "is the strongest light; no pilot can compare them"
                                          : "is the strongest light; none reached the film in a pilot");
}

White white_of(const Scene& scene, int threads, const std::shared_ptr<const GuidingData>& guides) {
  if (!scene.output.white) return main_light(scene, threads, guides);
  White white = *scene.output.white;
  if (!white.spectrum) white.spectrum = main_light(scene, threads, guides).spectrum;
  return white;
}

}  // namespace abbe
