#include "results/scene_warnings.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "scene/coincident_shapes.h"
#include "scene/lost_light.h"
#include "sensor/response/polarised_channels.h"
#include "transport/path/roulette.h"
#include "transport/plan/techniques.h"

namespace abbe {
namespace {

bool emits_in_sensor_range(const Scene& scene) {
  return std::ranges::any_of(emissions_of(scene).sensor_emissions,
                             [](double of_light) { return of_light > 0; });
}

// Sums of exactly 0 mean that no light was added to the film.
bool received_no_light(const Scene& scene, const RenderResult& result) {
  const bool counts = result.stats.samples_per_pixel > 0 && result.stats.nonfinite_samples == 0;
  return counts && !result.film.shape().crop &&
         result.film.bytes().find_first_not_of('\0') == std::string_view::npos &&
         emits_in_sensor_range(scene) && !dark_enclosure(scene);
}

}  // namespace

std::optional<std::string> unsampled_light_warning(const Scene& scene) {
  const std::vector<PathClass> lost = unsampled_paths(scene);
  if (lost.empty()) return std::nullopt;
  const std::string by =
      scene.render.integrator != Integrator::automatic
          ? fmt::format("integrator \"{}\" cannot", integrator_name(scene.render.integrator))
          : "no integrator can";
  return fmt::format("{} sample some light paths, whose light is missing: {}", by, fmt::join(lost, "; "));
}

std::optional<std::string> dark_camera_warning(const Scene& scene) {
  if (const auto light = find_light_on_probe(scene))
    return fmt::format(
        "the meter coincides within rounding with \"{}\" and does not receive its emission: separate them",
        scene.lights[*light].name);
  const auto shape = dark_enclosure(scene);
  if (!shape) return std::nullopt;
  return fmt::format("the camera is inside \"{}\", which is opaque and contains no light",
                     scene.shapes[*shape].name);
}

std::optional<std::string> coincidence_warning(const Scene& scene) {
  const auto lost = find_lost_surfaces(scene);
  if (!lost) return std::nullopt;
  const std::string others =
      lost->others > 0 ? fmt::format(" (and {} other pair{})", lost->others, lost->others == 1 ? "" : "s")
                       : "";
  return fmt::format(
      "\"{}\" and \"{}\" coincide within single precision{}: rays hit only one of the two surfaces, so that "
      "the other has no effect or its light is lost; separate them",
      scene.shapes[lost->shape].name, scene.shapes[lost->on].name, others);
}

std::optional<std::string> ignored_polarisation_warning(const Scene& scene) {
  if (!any_analyser(scene.channels) || scene.render.polarisation) return std::nullopt;
  return "the sensor measures polarisation, but render/polarisation is \"off\": all light is treated as "
         "unpolarised";
}

std::optional<std::string> undertrained_warning(const GuidingData* guides) {
  constexpr double kNegligible = 0.01;
  if (guides == nullptr) return std::nullopt;
  if (guides->undertrained)
    return "too few pilot photons contribute to the film to guide others: light that arrives through mirrors "
           "and glass is noisy, and its error is uncertain";
  if (guides->undertrained_fraction > kNegligible)
    return fmt::format(
        "{:.2g} % of the light that pilot photons found takes paths that fewer than {} of them "
        "took: that light is noisy, and its error is uncertain",
        100 * guides->undertrained_fraction, PhotonGuide::kEnoughPhotons);
  return std::nullopt;
}

std::optional<std::string> unknown_error_warning(const RelativeError& error) {
  if (error.few_samples)
    return fmt::format("error not yet known: {} sample{} half of the noise; increase --spp",
                       *error.few_samples, *error.few_samples == 1 ? " carries" : "s carry");
  if (error.hidden_noise > 0)
    return fmt::format("error not yet known: a pilot has {:.2g} times this noise; increase --spp",
                       error.hidden_noise);
  return std::nullopt;
}

std::optional<std::string> unused_settings_warning(const Scene& scene) {
  std::vector<std::string> keys;
  for (const std::string_view key : unused_photon_settings(scene))
    keys.push_back(fmt::format("render/photons/{}", key));
  if (keys.empty()) return std::nullopt;
  return fmt::format("integrator \"{}\" does not use these settings: {}",
                     integrator_name(scene.render.integrator), fmt::join(keys, ", "));
}

std::vector<std::string> render_warnings(const Scene& scene, const RenderResult& result) {
  const RenderStats& stats = result.stats;
  std::vector<std::string> warnings;
  if (stats.nonfinite_samples > 0)
    warnings.push_back(fmt::format("{} samples were dropped: not finite, or larger than the film can hold",
                                   stats.nonfinite_samples));
  if (stats.cut.paths > 0 && !scene.render.max_depth)
    warnings.push_back(
        fmt::format("{} paths were cut after {} bounces, with {:.3g} % of the initial throughput of all {} "
                    "paths: their light is missing",
                    stats.cut.paths, kMaxPathDepth,
                    100 * stats.cut.throughput() / static_cast<double>(stats.paths), stats.paths));
  if (received_no_light(scene, result))
    warnings.push_back(fmt::format(
        "no light reached the sensor in {} samples per pixel, although lights emit in its wavelength "
        "range: nothing can reach it, or the paths are too rare; check a ray with `abbe trace`, or "
        "increase --spp",
        stats.samples_per_pixel));
  return warnings;
}

}  // namespace abbe
