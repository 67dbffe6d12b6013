#include "results/measure_meter.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "io/error.h"
#include "results/rendered_film.h"
#include "results/scene_warnings.h"
#include "transport/render/choose_integrator.h"
#include "transport/render/pass.h"
#include "transport/render/threads.h"

namespace abbe {
namespace {

// Reports a sentence about a meter as a warning.
void warn_of_meter(const MeterCallbacks& caller, const Meter& meter, const std::string& sentence) {
  caller.warn(fmt::format("meter {}: {}", meter.name, sentence));
}

// Reports a sentence, if any, as a warning, or throws it if it is an error.
void report_warning(const MeterCallbacks& caller, const Meter& meter,
                    const std::optional<std::string>& sentence, bool is_error) {
  if (sentence && is_error) throw Error(ErrorCode::scene, meter.name, *sentence);
  if (sentence) warn_of_meter(caller, meter, *sentence);
}

}  // namespace

std::vector<const Meter*> chosen_meters(const MeteredScene& scene, const std::vector<std::string>& names,
                                        const std::string& option) {
  std::vector<const Meter*> meters;
  std::vector<std::string_view> known;
  for (const Meter& meter : scene.meters) {
    known.push_back(meter.name);
    if (names.empty() || std::find(names.begin(), names.end(), meter.name) != names.end())
      meters.push_back(&meter);
  }
  for (const std::string& name : names)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw Error(ErrorCode::usage, option,
                  fmt::format("no such meter (got \"{}\", allowed {})", name, fmt::join(known, ", ")));
  return meters;
}

MeterMeasurement measure_meter(Scene scene, const Meter& meter, RenderOptions options,
                               const MeterCallbacks& caller, Inputs& inputs) {
  options.target_planes = kSpectrumPlane;  // the planes of the meter's three figures precede this one
  const bool chooses = scene.render.integrator == Integrator::automatic;
  const IntegratorChoice choice = choose_integrator(scene, thread_count(options.threads));
  scene.render.integrator = choice.integrator;
  options.guides = choice.guides;
  report_warning(caller, meter, dark_camera_warning(scene), caller.strict);
  report_warning(caller, meter, unsampled_light_warning(scene), caller.strict && !chooses);
  report_warning(caller, meter, undertrained_warning(choice.guides.get()), false);
  report_warning(caller, meter, unused_settings_warning(scene), false);
  inputs.reserve_memory("the film", film_bytes(scene, options));
  inputs.reserve_memory("the paths from lights of a sample", bytes_of_light_paths(scene));
  RenderResult result = caller.render(scene, options);
  result.stats.error.few_samples = few_samples(result.film, kSpectrumPlane);
  inputs.release_memory(film_bytes(scene, options) + bytes_of_light_paths(scene));
  for (const std::string& loss : render_warnings(scene, result)) warn_of_meter(caller, meter, loss);
  report_warning(caller, meter, unknown_error_warning(result.stats.error), false);
  if (options.target_error && !options.time_limit_s && !std::isfinite(result.stats.error.median))
    warn_of_meter(caller, meter,
                  fmt::format("a pilot found no light at the meter: {} has no effect", caller.error_name));
  return {meter, scene.render.integrator, scene.render.seed, read_meter(meter, result.film, scene.exposure_s),
          result.stats};
}

}  // namespace abbe
