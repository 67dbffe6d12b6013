#include "results/measure_meter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "io/error.h"
#include "results/rendered_film.h"
#include "results/scene_warnings.h"
#include "spectral/sources.h"
#include "transport/render/choose_integrator.h"
#include "transport/render/pass.h"
#include "transport/render/threads.h"

namespace abbe {
namespace {

constexpr std::array<MeterUnits, kMeterQuantityNames.size()> kUnits{
    {{"W/m2", "lx", "photons/(s m2)"},
     {"W", "lm", "photons/s"},
     {"W/(m2 sr)", "cd/m2", "photons/(s m2 sr)"},
     {"W/sr", "cd", "photons/(s sr)"}}};

Film::Average scaled(Film::Average value, double factor) {
  value.mean *= factor;
  value.standard_error *= factor;
  return value;
}

LightReading light_in(const Film& film, const Crop& part, double factor) {
  const auto read = [&](int plane) {
    return scaled(film.average(plane, part.x0, part.y0, part.x1, part.y1), factor);
  };
  return {read(kRadiantPlane), read(kLuminousPlane), scaled(read(kPhotonPlane), kAvogadro / 1e6)};
}

// Reports a sentence, if any, as a warning, or throws it if it is an error.
void report_warning(const MeterCallbacks& caller, const Meter& meter,
                    const std::optional<std::string>& sentence, bool is_error = false) {
  if (sentence && is_error) throw Error(ErrorCode::scene, meter.name, *sentence);
  if (sentence) caller.warn(fmt::format("meter {}: {}", meter.name, *sentence));
}

}  // namespace

const MeterUnits& units_of(MeterQuantity quantity) {
  return kUnits.at(static_cast<std::size_t>(quantity));
}

MeterReading read_meter(const Meter& meter, const Film& film, double exposure_s) {
  const double factor = per_irradiance(meter) / exposure_s;
  const auto& [columns, rows] = meter.cells;
  const int width = film.width() / columns;
  const int height = film.height() / rows;
  MeterReading reading{light_in(film, film.crop(), factor), {}, {}};
  // Flux and intensity are per cell, other quantities per area.
  const double of_cell = meter.quantity == MeterQuantity::flux || meter.quantity == MeterQuantity::intensity
                             ? factor / (columns * rows)
                             : factor;
  for (int y = 0; y < rows && columns * rows > 1; ++y)
    for (int x = 0; x < columns; ++x)
      reading.cells.push_back(
          light_in(film, {x * width, y * height, (x + 1) * width, (y + 1) * height}, of_cell));
  for (int bin = 0; meter.spectrum && bin < meter.spectrum->count; ++bin)
    reading.spectrum.push_back(scaled(film.average(kSpectrumPlane + bin), factor / meter.spectrum->step_nm));
  return reading;
}

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
  report_warning(caller, meter, undertrained_warning(choice.guides.get()));
  report_warning(caller, meter, unused_settings_warning(scene));
  inputs.reserve_memory("the film", film_bytes(scene, options));
  inputs.reserve_memory("the paths from lights of a sample", bytes_of_light_paths(scene));
  RenderResult result = caller.render(scene, options);
  result.stats.error.few_samples = few_samples(result.film, kSpectrumPlane);
  inputs.release_memory(film_bytes(scene, options) + bytes_of_light_paths(scene));
  for (const std::string& loss : render_warnings(scene, result)) report_warning(caller, meter, loss);
  report_warning(caller, meter, unknown_error_warning(result.stats.error));
  if (options.target_error && !options.time_limit_s && !std::isfinite(result.stats.error.median))
    report_warning(caller, meter,
                   fmt::format("a pilot found no light at the meter: {} has no effect", caller.error_name));
  return {meter, scene.render.integrator, scene.render.seed, read_meter(meter, result.film, scene.exposure_s),
          result.stats};
}

}  // namespace abbe
