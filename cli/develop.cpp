#include "cli/develop.h"

#include <algorithm>
#include <array>
#include <deque>

#include "cli/answer.h"
#include "cli/output_files.h"
#include "develop/develop.h"
#include "develop/film_file.h"
#include "develop/radiance.h"
#include "film/spectral.h"
#include "film/white.h"
#include "io/atomic_file.h"
#include "io/error.h"
#include "io/extension.h"
#include "io/file_lock.h"
#include "sensor/film/recorded_white.h"
#include "sensor/readout/speed.h"

namespace abbe::cli {
namespace {

namespace fs = std::filesystem;

bool is_exr(const fs::path& path) {
  return path.extension() == ".exr";
}

std::vector<fs::path> check_outputs(const DevelopOptions& options) {
  std::vector<fs::path> files = options.outputs;
  for (const fs::path& output : options.outputs) require_extension(output, {".exr", ".tif", ".tiff", ".png"});
  if (!options.display.empty()) {
    require_picture_extension(options.display);
    files.push_back(options.display);
  }
  for (const fs::path& file : files) require_writable(file);
  require_distinct(files, std::array{options.film, options.scene});
  return files;
}

// What the picture is shown by; a user's configuration matters to nothing else.
ViewOptions view_of(const DevelopOptions& options) {
  return options.display.empty() ? ViewOptions{} : ViewOptions{users_configuration(), {}, {}};
}

// The white asked for, the last of them, and what is left to ask for.
struct Asked {
  std::optional<std::string> white;
  std::vector<Override> others;
};
Asked asked(const DevelopOptions& options) {
  Asked all;
  for (const Override& o : options.overrides)
    if (o.pointer == kWhitePointer)
      all.white = o.value;
    else
      all.others.push_back(o);
  return all;
}

FilmSensor sensor_of(const Image& film, const fs::path& path, const std::vector<Override>& overrides,
                     const DevelopOptions& options, std::optional<Chromaticity> white = {}) {
  Diagnostics diagnostics;
  FilmSensor sensor =
      accepted(film_sensor(film, path, overrides, view_of(options), white, diagnostics), diagnostics);
  require_planes(film, sensor, options.film);
  return sensor;
}

ExposedFilm expose_spectral(Image file, const DevelopOptions& options, Inputs& inputs) {
  const auto [white, others] = asked(options);
  const Image told{0, 0, {}, file.metadata};
  const SpectralImage image = spectral_image(std::move(file), options.film.string());
  if (!options.scene.empty()) {
    Diagnostics diagnostics;
    std::optional<Scene> scene = load_scene(options.scene, {}, diagnostics, &inputs);
    if (!scene) check(diagnostics);  // warnings are about what nobody renders here
    settle_white(*scene, options.scene, told, white);
    Diagnostics of_bands;
    Image film = seen_by(*scene, image, options.film, of_bands);
    check(of_bands);
    FilmSensor sensor = sensor_of(film, options.scene, others, options);
    return {std::move(film), std::move(sensor)};
  }
  if (!options.outputs.empty())
    throw Error(ErrorCode::usage, "-o", "a spectral film needs a sensor that looks at it: --scene");
  return observed_film(image, view_of(options),
                       white ? std::optional(asked_white(*white, told)) : recorded_white(told));
}

ExposedFilm load(const DevelopOptions& options, Inputs& inputs) {
  Image film = read_film(options.film, &inputs);
  if (is_spectral(film)) return expose_spectral(std::move(film), options, inputs);
  if (!options.scene.empty())
    throw Error(ErrorCode::usage, "--scene", "only a spectral film takes a sensor: this one has its own");
  const auto [white, others] = asked(options);
  const auto xy = white ? std::optional(asked_white(*white, film)) : std::nullopt;
  FilmSensor sensor = sensor_of(film, options.film, others, options, xy);
  return {std::move(film), std::move(sensor)};
}

Json report(const FilmSensor& sensor, const std::vector<PlaneFigures>& planes) {
  Json answer;
  answer["planes"] = sensor.planes;
  for (const PlaneFigures& plane : planes) {
    if (!sensor.readout) {
      answer["mean"].push_back(plane.mean);
      if (plane.render_error) answer["render_error"].push_back(*plane.render_error);
      continue;
    }
    answer["mean_e"].push_back(plane.mean);
    answer["photon_noise_e"].push_back(plane.noise.photon_e);
    answer["dark_noise_e"].push_back(plane.noise.dark_e);
    answer["read_noise_e"].push_back(plane.noise.read_e);
    answer["quantisation_noise_e"].push_back(plane.noise.quantisation_e);
    answer["sensor_noise_e"].push_back(plane.noise.total_e);
    answer["render_error_e"].push_back(plane.render_error.value());
    answer["saturated_share"].push_back(plane.saturated_share);
  }
  if (sensor.readout && sensor.electrons_per_lx_s)
    answer["iso_speed"] = saturation_speed(*sensor.readout, *sensor.electrons_per_lx_s);
  return answer;
}

}  // namespace

int develop(const DevelopOptions& options) {
  const std::vector<fs::path> outputs = check_outputs(options);
  std::deque<FileLock> locks;
  for (const fs::path& file : outputs) locks.emplace_back(file);
  Inputs inputs(options.max_memory_bytes);
  const ExposedFilm exposed = load(options, inputs);
  require_distinct(outputs, inputs.files());
  const FilmSensor& sensor = exposed.sensor;
  if (sensor.display) require_distinct(outputs, sensor.display->files());
  const bool wants_raw = std::any_of(options.outputs.begin(), options.outputs.end(),
                                     [](const fs::path& path) { return !is_exr(path); });
  if (wants_raw && !sensor.readout)
    throw Error(ErrorCode::usage, "-o",
                "the film has no read-out to make codes with (allowed: --set '/readout={...}', or a .exr)");
  if (!options.display.empty()) require_display(sensor);

  // At most three planes beside each of the film and of its variance.
  inputs.take_memory("developing", 3 * exposed.film.memory_bytes());
  const DevelopedFilm developed = abbe::develop(exposed, options.seed.value_or(render_seed(exposed.film)));
  const Image planes = display_planes(sensor, developed.calibrated);
  const std::optional<double> scale =
      sensor.display_exposure ? std::optional(1 / *sensor.display_exposure) : std::nullopt;
  for (const fs::path& output : options.outputs)
    if (is_exr(output))
      write_parts(output, developed, planes, sensor, scale);
    else
      write_raw(output, developed);
  if (!options.display.empty()) write_display(options.display, planes, sensor);
  print(report(sensor, plane_figures(sensor, developed)), options.json);
  return 0;
}

}  // namespace abbe::cli
