#include "film/shortcomings.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "scene/contact.h"
#include "scene/dark_enclosure.h"
#include "sensor/response/stokes_channels.h"
#include "transport/path/roulette.h"
#include "transport/plan/emissions.h"
#include "transport/plan/photon_settings.h"
#include "transport/plan/techniques.h"

namespace abbe {
namespace {

bool emits_what_is_seen(const Scene& scene) {
  const std::vector<double> seen = emissions_of(scene).seen;
  return std::any_of(seen.begin(), seen.end(), [](double of_light) { return of_light > 0; });
}

// Sums that are exactly 0 are those of a film that no light has been added to.
bool found_nothing(const Scene& scene, const RenderResult& result) {
  const bool counts = result.stats.samples_per_pixel > 0 && result.stats.nonfinite_samples == 0;
  return counts && !result.film.shape().crop &&
         result.film.bytes().find_first_not_of('\0') == std::string_view::npos && emits_what_is_seen(scene) &&
         !dark_enclosure(scene);
}

}  // namespace

std::optional<std::string> lost_light(const Scene& scene) {
  const std::vector<PathClass> lost = unreached(scene);
  if (lost.empty()) return std::nullopt;
  const std::string by =
      scene.render.integrator != Integrator::automatic
          ? fmt::format("integrator \"{}\" does not reach", integrator_name(scene.render.integrator))
          : "no technique reaches";
  return fmt::format("light that {} is missing: {}", by, fmt::join(lost, "; "));
}

std::optional<std::string> dark_camera(const Scene& scene) {
  if (const auto light = light_on_meter(scene))
    return fmt::format(
        "the meter lies, within rounding, on \"{}\" and receives nothing of what that emits: keep them apart",
        scene.lights[*light].name);
  const auto shape = dark_enclosure(scene);
  if (!shape) return std::nullopt;
  return fmt::format("the camera stands within \"{}\", which is opaque and has no light inside",
                     scene.shapes[*shape].name);
}

std::optional<std::string> hidden_sheet(const Scene& scene) {
  if (const auto sheet = lost_sheet(scene))
    return fmt::format("the thin sheet \"{}\" lies on \"{}\", which is met instead: keep them apart",
                       scene.shapes[sheet->shape].name, scene.shapes[sheet->on].name);
  const auto coat = lost_coat(scene);
  if (!coat) return std::nullopt;
  const std::string size = coat->reflectance
                               ? fmt::format(" (a thin coat would take a reflectance of {} to {:.3g})",
                                             LostCoat::kBelow, *coat->reflectance)
                               : "";
  return fmt::format(
      "\"{}\" lies on all of the opaque \"{}\" and has no effect{}: keep them apart, or give that a coated "
      "material",
      scene.shapes[coat->shape].name, scene.shapes[coat->on].name, size);
}

std::optional<std::string> hidden_lamp(const Scene& scene) {
  const auto contact = lost_lamp(scene);
  if (!contact) return std::nullopt;
  const Light& lamp = scene.lights[contact->light];
  const std::string& on = scene.shapes[contact->on].name;
  const auto* emitter = std::get_if<AreaLight>(&lamp.kind);
  if (emitter == nullptr)
    return fmt::format(
        "the lamp \"{}\" stands on \"{}\", on one side or the other by rounding: keep them apart", lamp.name,
        on);
  if (emitter->shape == contact->on)
    return fmt::format(
        "triangles of the lamp \"{}\" lie on each other, of which one is met and all are lit from: keep one, "
        "two_sided where both sides emit",
        lamp.name);
  return fmt::format("the lamp \"{}\" lies on \"{}\", which may be met instead: keep them apart", lamp.name,
                     on);
}

std::optional<std::string> unpolarised_measurement(const Scene& scene) {
  if (!any_analyser(scene.channels) || scene.render.polarisation) return std::nullopt;
  return "the sensor measures how light is polarised, and render/polarisation is \"off\": all light will "
         "count "
         "as unpolarised";
}

std::optional<std::string> rare_photons(const Guides* guides) {
  constexpr double kNegligible = 0.01;
  if (guides == nullptr) return std::nullopt;
  if (guides->photons_are_rare)
    return "too few pilot photons reach the sensor to guide others: light that arrives through mirrors and "
           "glass is noisy, and its error is uncertain";
  if (guides->undertrained_fraction > kNegligible)
    return fmt::format(
        "{:.2g} % of the light that pilot photons found takes paths that fewer than {} of them "
        "took: that light is noisy, and its error is uncertain",
        100 * guides->undertrained_fraction, Aim::kEnough);
  return std::nullopt;
}

std::optional<std::string> unknown_error(const RelativeError& error) {
  if (error.few_samples)
    return fmt::format("error not yet known: {} sample{} half of the noise; increase --spp",
                       *error.few_samples, *error.few_samples == 1 ? " carries" : "s carry");
  if (error.hidden_noise > 0)
    return fmt::format("error not yet known: a pilot has {:.2g} times this noise; increase --spp",
                       error.hidden_noise);
  return std::nullopt;
}

std::optional<std::string> unused_settings(const Scene& scene) {
  std::vector<std::string> keys;
  for (const std::string_view key : unused_photon_settings(scene))
    keys.push_back(fmt::format("render/photons/{}", key));
  if (keys.empty()) return std::nullopt;
  return fmt::format("without effect, as integrator \"{}\" makes no use of it: {}",
                     integrator_name(scene.render.integrator), fmt::join(keys, ", "));
}

std::vector<std::string> left_out(const Scene& scene, const RenderResult& result) {
  const RenderStats& stats = result.stats;
  std::vector<std::string> told;
  if (stats.nonfinite_samples > 0)
    told.push_back(fmt::format("{} samples were left out: not finite, or more than the film can hold",
                               stats.nonfinite_samples));
  if (stats.cut.paths > 0 && !scene.render.max_depth)
    told.push_back(
        fmt::format("{} paths were cut after {} events, with {:.3g} % of what all {} set out with: their "
                    "light is missing",
                    stats.cut.paths, kMostEvents,
                    100 * stats.cut.throughput() / static_cast<double>(stats.paths), stats.paths));
  if (found_nothing(scene, result))
    told.push_back(
        fmt::format("no light was found by {} samples per pixel, although lights emit what the sensor sees: "
                    "none comes there, or by ways too rare for so many",
                    stats.samples_per_pixel));
  return told;
}

}  // namespace abbe
