#include "film/measure_meter.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "film/rendered_film.h"
#include "film/shortcomings.h"
#include "io/error.h"
#include "transport/render/choose_integrator.h"
#include "transport/render/collect.h"
#include "transport/render/threads.h"

namespace abbe {
namespace {

void warn_of_meter(const MeterCaller& caller, const Meter& meter, const std::string& sentence) {
  caller.warn(fmt::format("meter {}: {}", meter.name, sentence));
}

void tell_shortcoming(const MeterCaller& caller, const Meter& meter,
                      const std::optional<std::string>& sentence, bool is_error) {
  if (sentence && is_error) throw Error(ErrorCode::scene, meter.name, *sentence);
  if (sentence) warn_of_meter(caller, meter, *sentence);
}

}  // namespace

std::vector<const Meter*> chosen_meters(const MeteredScene& scene, const std::vector<std::string>& names,
                                        const std::string& asked_by) {
  std::vector<const Meter*> meters;
  std::vector<std::string_view> known;
  for (const Meter& meter : scene.meters) {
    known.push_back(meter.name);
    if (names.empty() || std::find(names.begin(), names.end(), meter.name) != names.end())
      meters.push_back(&meter);
  }
  for (const std::string& name : names)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw Error(ErrorCode::usage, asked_by,
                  fmt::format("no such meter (got \"{}\", allowed {})", name, fmt::join(known, ", ")));
  return meters;
}

MeterMeasurement measure_meter(Scene scene, const Meter& meter, RenderOptions how, const MeterCaller& caller,
                               Inputs& inputs) {
  how.target_planes = kSpectrumPlane;  // those before
  const bool chooses = scene.render.integrator == Integrator::automatic;
  const IntegratorChoice choice = choose_integrator(scene, thread_count(how.threads));
  scene.render.integrator = choice.integrator;
  how.guides = choice.guides;
  tell_shortcoming(caller, meter, dark_camera(scene), caller.strict);
  tell_shortcoming(caller, meter, lost_light(scene), caller.strict && !chooses);
  tell_shortcoming(caller, meter, rare_photons(choice.guides.get()), false);
  tell_shortcoming(caller, meter, unused_settings(scene), false);
  inputs.take_memory("the film", film_bytes(scene, how));
  inputs.take_memory("the paths from lights of a sample", bytes_of_light_paths(scene));
  RenderResult result = caller.render(scene, how);
  result.stats.error.few_samples = few_samples(result.film, kSpectrumPlane);
  inputs.give_back_memory(film_bytes(scene, how) + bytes_of_light_paths(scene));
  for (const std::string& loss : left_out(scene, result)) warn_of_meter(caller, meter, loss);
  tell_shortcoming(caller, meter, unknown_error(result.stats.error), false);
  if (how.target_error && !how.time_limit_s && !std::isfinite(result.stats.error.median))
    warn_of_meter(caller, meter,
                  fmt::format("a pilot found no light there: {} had nothing to wait for", caller.error_name));
  return {meter, scene.render.integrator, scene.render.seed, read_meter(meter, result.film, scene.exposure_s),
          result.stats};
}

}  // namespace abbe
