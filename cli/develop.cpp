#include "cli/develop.h"

#include <algorithm>
#include <array>
#include <deque>
#include <functional>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "calibration/output/dng_profile.h"
#include "cli/answer.h"
#include "cli/output_files.h"
#include "develop/develop.h"
#include "develop/dng_profile_file.h"
#include "develop/film_file.h"
#include "develop/polarisation.h"
#include "develop/polarisation_camera.h"
#include "develop/radiance.h"
#include "film/relit_white.h"
#include "film/spectral.h"
#include "film/white.h"
#include "io/atomic_file.h"
#include "io/error.h"
#include "io/exr.h"
#include "io/extension.h"
#include "io/file_lock.h"
#include "io/picture.h"
#include "sensor/film/recorded_white.h"
#include "sensor/readout/speed.h"
#include "validation/picture/polarisation_maps.h"

namespace abbe::cli {
namespace {

namespace fs = std::filesystem;

// The file of an exposure among several, counted from 1: "dark_0003.tif".
fs::path numbered(const fs::path& path, std::uint32_t frame, const DevelopOptions& options) {
  if (path.empty() || options.frames == 1) return path;
  return path.parent_path() /
         fmt::format("{}_{:04}{}", path.stem().string(), frame + 1, path.extension().string());
}

fs::path map_file(const DevelopOptions& options, const std::string& map) {
  return options.polarisation / (map + ".png");
}
fs::path values_file(const DevelopOptions& options) {
  return options.polarisation / "polarisation.exr";
}

// The files that tell of polarisation, in a folder that is made for them.
std::vector<fs::path> polarisation_files(const DevelopOptions& options) {
  if (options.polarisation.empty()) return {};
  std::error_code ignored;
  fs::create_directories(options.polarisation, ignored);
  std::vector<fs::path> files{values_file(options)};
  for (const char* map : {kDegreeMap, kLinearDegreeMap, kAngleMap}) files.push_back(map_file(options, map));
  return files;
}

bool sets(const DevelopOptions& options, std::string_view pointer) {
  return std::any_of(options.overrides.begin(), options.overrides.end(),
                     [pointer](const Override& o) { return o.pointer == pointer; });
}

// Refuses options that others leave without effect.
void require_effect(const DevelopOptions& options) {
  const auto refuse = [](const char* option, std::string_view why) {
    throw Error(ErrorCode::usage, option, std::string(why));
  };
  const auto one_of_two = [&](const char* option, std::string_view pointer) {
    if (sets(options, pointer))
      refuse(option, fmt::format("is what --set {} says too: one of them", pointer));
  };
  if (options.iso) one_of_two("--iso", kIsoPointer);
  if (options.white) one_of_two("--white", kWhitePointer);
  const char* shows = options.display_exposure       ? "--exposure"
                      : !options.exposure_of.empty() ? "--exposure-of"
                      : options.flattens_field       ? "--field"
                      : options.white                ? "--white"
                      : sets(options, kWhitePointer) ? kWhitePointer
                                                     : "";
  if (*shows != 0 && options.display.empty() && options.outputs.empty())
    refuse(shows, "only what is written takes it (allowed with --display or -o)");
  if (!options.frame) return;
  if (!options.lights.empty())
    refuse("--light", "a frame of --frame sees no scene, and no light of one (allowed without --frame)");
  if (options.exposure_s && std::holds_alternative<BiasFrame>(*options.frame))
    refuse("--exposure-s", "a bias frame is exposed for no time (allowed with --frame dark or flat)");
}

std::vector<fs::path> check_outputs(const DevelopOptions& options) {
  require_effect(options);
  for (const fs::path& output : options.outputs) require_developed_extension(output);
  if (options.display.empty())
    require_no_view(options.view, "--display");
  else
    require_picture_extension(options.display);
  std::vector<fs::path> files = polarisation_files(options);
  for (std::uint32_t frame = 0; frame < options.frames; ++frame) {
    for (const fs::path& output : options.outputs) files.push_back(numbered(output, frame, options));
    if (!options.display.empty()) files.push_back(numbered(options.display, frame, options));
  }
  require_distinct(files, std::array{options.film, options.scene});
  return files;
}

// What the picture is shown by; a user's configuration matters to nothing else.
ViewOptions view_of(const DevelopOptions& options) {
  if (options.display.empty()) return {};
  ViewOptions view = options.view;
  if (view.config.empty()) view.config = users_configuration();
  return view;
}

// The white asked for, of --set the last, and what is left to ask for.
struct Asked {
  std::optional<std::string> white;
  std::vector<Override> others;
};
Asked asked(const DevelopOptions& options) {
  Asked all{options.white, {}};
  for (const Override& o : options.overrides)
    if (o.pointer == kWhitePointer)
      all.white = o.value;
    else
      all.others.push_back(o);
  if (options.iso) all.others.push_back({kIsoPointer, fmt::format("{}", *options.iso), "--iso"});
  return all;
}

// The option that asks for the white.
const char* white_option(const DevelopOptions& options) {
  return options.white ? "--white" : "--set";
}

FilmSensor sensor_of(const Image& film, const fs::path& path, const std::vector<Override>& overrides,
                     const DevelopOptions& options, const std::optional<White>& white = {}) {
  Diagnostics diagnostics;
  const auto xy = white ? std::optional(white->xy) : std::nullopt;
  FilmSensor sensor =
      accepted(film_sensor(film, path, overrides, view_of(options), xy, diagnostics), diagnostics);
  if (white) sensor.white_name = white->name;
  require_planes(film, sensor, options.film);
  return sensor;
}

ExposedFilm expose_spectral(Image file, const DevelopOptions& options, Inputs& inputs) {
  const auto [white, others] = asked(options);
  Image told{0, 0, {}, file.metadata};
  for (const ImageChannel& channel : file.channels) told.channels.push_back({channel.name, {}});
  const SpectralImage image = spectral_image(std::move(file), options.film.string());
  if (!options.scene.empty()) {
    Diagnostics diagnostics;
    std::optional<Scene> scene = load_scene(options.scene, {}, diagnostics, &inputs);
    if (!scene) check(diagnostics);  // warnings are about what nobody renders here
    settle_white(*scene, options.scene, told, white, white_option(options));
    Diagnostics of_bands;
    Image film = seen_by(*scene, image, options.film, of_bands);
    check(of_bands);
    FilmSensor sensor = sensor_of(film, options.scene, others, options);
    return {std::move(film), std::move(sensor)};
  }
  const char* unmet = !options.outputs.empty() ? "-o"
                      : options.iso            ? "--iso"
                      : !others.empty()        ? "--set"
                                               : "";
  if (*unmet != 0)
    throw Error(ErrorCode::usage, unmet, "a spectral film needs a sensor that looks at it: --scene");
  if (!white) return observed_film(image, options.film, view_of(options), {});
  const White chosen = asked_white(*white, told, white_option(options));
  ExposedFilm seen = observed_film(image, options.film, view_of(options), chosen.xy);
  seen.sensor.white_name = chosen.name;
  return seen;
}

// What a film tells of polarisation, whatever looks at it: itself, or by what lies behind its polarisers.
void write_polarisation(const Image& film, const DevelopOptions& options) {
  const Image solved = stokes_planes(film).empty() ? stokes_of_polarisers(film) : Image{};
  const Image& measured = solved.channels.empty() ? film : solved;
  Image values = polarisation_image(measured);
  values.channels.insert(values.channels.end(), solved.channels.begin(), solved.channels.end());
  const std::vector<PolarisationMap> maps =
      polarisation_maps(polarisation_of_light(measured),
                        solved.channels.empty() ? Measured::all : Measured::linear, film.width, film.height);
  std::vector<std::function<void()>> writers;
  writers.emplace_back([&] { write_exr(values_file(options), values); });
  for (const PolarisationMap& map : maps)
    writers.emplace_back([&] { write_picture(map_file(options, map.name), map.map); });
  write_all(writers);
}

// Lets the lights of a film count as the options ask: the white that it then has of its lights, where that
// is another and none is asked for.
std::optional<White> relight_as_asked(Image& film, const DevelopOptions& options) {
  if (options.lights.empty()) return std::nullopt;
  const RelitWhite relit = asked(options).white ? RelitWhite{} : relit_white(film, options.lights);
  if (!relit.shortcoming.empty()) say("warning: --light: " + relit.shortcoming);
  relight(film, options.lights);
  return relit.white;
}

ExposedFilm load(const DevelopOptions& options, Inputs& inputs) {
  Image film = read_film(options.film, &inputs);
  const std::optional<White> relit = relight_as_asked(film, options);
  if (!options.polarisation.empty()) write_polarisation(film, options);
  if (is_spectral(film)) {
    if (relit) record_white(relit->name, relit->xy, relit->asked, film.metadata);
    return expose_spectral(std::move(film), options, inputs);
  }
  if (!options.scene.empty())
    throw Error(ErrorCode::usage, "--scene", "only a spectral film takes a sensor: this one has its own");
  const auto [white, others] = asked(options);
  const auto chosen = white ? std::optional(asked_white(*white, film, white_option(options))) : relit;
  FilmSensor sensor = sensor_of(film, options.film, others, options, chosen);
  return {std::move(film), std::move(sensor)};
}

/// Figures that `develop` reports about the first exposure.
struct Report {
  std::vector<PlaneFigures> planes;
  std::optional<double> shown_as_white;  ///< Nothing where no display can show the film.
};

Json json_of(const FilmSensor& sensor, const Report& report) {
  const std::vector<PlaneFigures>& planes = report.planes;
  Json answer;
  answer["planes"] = sensor.planes;
  for (const PlaneFigures& plane : planes) {
    const Json render_error = plane.render_error ? Json(*plane.render_error) : Json();
    if (!sensor.readout) {
      answer["mean"].push_back(plane.mean);
      answer["render_error"].push_back(render_error);
      continue;
    }
    answer["mean_e"].push_back(plane.mean);
    answer["photon_noise_e"].push_back(plane.noise.photon_e);
    answer["dark_noise_e"].push_back(plane.noise.dark_e);
    answer["read_noise_e"].push_back(plane.noise.read_e);
    answer["row_noise_e"].push_back(plane.noise.row_e);
    answer["quantisation_noise_e"].push_back(plane.noise.quantisation_e);
    answer["sensor_noise_e"].push_back(plane.noise.total_e);
    answer["render_error_e"].push_back(render_error);
    answer["saturated_share"].push_back(plane.saturated_share);
  }
  if (sensor.readout && sensor.electrons_per_lx_s)
    answer["iso_speed"] = saturation_speed(*sensor.readout, *sensor.electrons_per_lx_s);
  if (!sensor.camera_space.empty()) answer["camera_space"] = sensor.camera_space;
  if (report.shown_as_white) answer[kDisplayExposureKey] = *report.shown_as_white;
  return answer;
}

// Changes what was exposed as the options ask. `diagnostics` gets the warnings about the film's own scene.
void expose_anew(ExposedFilm& exposed, const DevelopOptions& options, Diagnostics& diagnostics) {
  if (options.exposure_s) expose_for(exposed, *options.exposure_s, diagnostics);
  if (options.frame) expose_to(exposed, *options.frame);
  if (options.display_exposure) exposed.sensor.display_exposure = options.display_exposure;
}

// Warns of neutrals that are tinted, and flattens the field if that was requested.
void set_field(FilmSensor& sensor, const DevelopOptions& options) {
  sensor.flattens_field = options.flattens_field;
  if (!sensor.white_field || !sensor.display || options.frame) {
    if (options.flattens_field)
      say("warning: --field: without effect, as the response of the film's channels to white does not change "
          "over the field, or the film does not record it");
    return;
  }
  const std::string remedy =
      options.outputs.empty() ? "--field balances pictures over the field"
                              : "--field balances pictures over the field, and raw files need a flat field";
  const double shift = neutral_shift(*sensor.white_field, sensor.display->to_xyz_d65());
  const auto warning = tinted_corners(shift, remedy);
  const bool is_flat = options.flattens_field && options.outputs.empty();
  if (warning && !is_flat) say("warning: " + *warning);
}

void take_profile(FilmSensor& sensor, const DevelopOptions& options, Inputs& inputs) {
  if (options.profile.empty()) return;
  const auto is_dng = [](const fs::path& path) { return extension_of(path) == ".dng"; };
  if (std::none_of(options.outputs.begin(), options.outputs.end(), is_dng))
    throw Error(ErrorCode::usage, "--profile", "only a .dng takes it (allowed with -o FILE.dng)");
  if (sensor.channels.size() != 3)
    throw Error(ErrorCode::usage, "--profile",
                fmt::format("its matrices are for three channels (got {})", sensor.channels.size()));
  Diagnostics diagnostics;
  inputs.add_file(options.profile);
  const DngProfile profile = accepted(read_dng_profile(options.profile, diagnostics), diagnostics);
  require_same_camera(profile, sensor, options.profile);
  for (const RawLight& light : profile.lights) sensor.lights.push_back(light_for(sensor.channels, light));
}

// The noise of a read-out is all that exposures of one film differ by.
void require_noise(const FilmSensor& sensor, const DevelopOptions& options) {
  const char* unmet = options.frames > 1 ? "--frames" : options.seed ? "--seed" : "";
  if (*unmet != 0 && !sensor.readout)
    throw Error(ErrorCode::usage, unmet,
                "the film has no read-out whose noise it could draw (allowed: --set '/readout={...}')");
}

Report report_of(const FilmSensor& sensor, const DevelopedFilm& developed, const Image& planes) {
  Report report{plane_figures(sensor, developed), {}};
  if (sensor.display) report.shown_as_white = shown_as_white(sensor, planes);
  return report;
}

// Develops one exposure into all its files, each whatever becomes of the others.
Report develop_frame(const ExposedFilm& exposed, const DevelopOptions& options, std::uint32_t frame) {
  const FilmSensor& sensor = exposed.sensor;
  const std::uint64_t seed = options.seed.value_or(render_seed(exposed.film));
  const DevelopedFilm developed = abbe::develop(exposed, seed, frame);
  const Image planes = display_planes(sensor, developed.calibrated);
  std::vector<std::function<void()>> writers;
  for (const fs::path& output : options.outputs)
    writers.emplace_back([&, path = numbered(output, frame, options)] {
      if (is_raw_file(path))
        write_raw(path, developed, sensor);
      else
        write_parts(path, developed, planes, sensor);
    });
  if (!options.display.empty())
    writers.emplace_back([&] { write_display(numbered(options.display, frame, options), planes, sensor); });
  write_all(writers);
  return frame == 0 ? report_of(sensor, developed, planes) : Report{};
}

// The figures of the first exposure; of all, the files are written, and the first failure is thrown in the
// end.
Report develop_frames(const ExposedFilm& exposed, const DevelopOptions& options) {
  Report report;
  std::vector<std::function<void()>> writers;
  for (std::uint32_t frame = 0; frame < options.frames; ++frame)
    writers.emplace_back([&, frame] {
      Report of_frame = develop_frame(exposed, options, frame);
      if (frame == 0) report = std::move(of_frame);
    });
  write_all(writers);
  return report;
}

// The display exposure that this command would find for the film of --exposure-of.
double exposure_of_film(const DevelopOptions& options, Inputs& inputs) {
  DevelopOptions other = options;
  other.film = options.exposure_of;
  other.polarisation.clear();
  other.frame.reset();
  Diagnostics warnings;  // of the film that is developed, which are given for that one
  ExposedFilm exposed = load(other, inputs);
  require_display(exposed.sensor);
  expose_anew(exposed, other, warnings);
  exposed.sensor.flattens_field = options.flattens_field;
  const std::uint64_t seed = options.seed.value_or(render_seed(exposed.film));
  return shown_as_white(exposed.sensor,
                        display_planes(exposed.sensor, abbe::develop(exposed, seed).calibrated));
}

}  // namespace

int develop(const DevelopOptions& options) {
  const std::vector<fs::path> outputs = check_outputs(options);
  std::deque<FileLock> locks;
  for (const fs::path& file : writable_among(outputs)) locks.emplace_back(file);
  Inputs inputs(options.max_memory_bytes);
  ExposedFilm exposed = load(options, inputs);
  take_profile(exposed.sensor, options, inputs);
  if (!options.exposure_of.empty()) exposed.sensor.display_exposure = exposure_of_film(options, inputs);
  require_distinct(outputs, inputs.files());
  const FilmSensor& sensor = exposed.sensor;
  if (sensor.display) require_distinct(outputs, sensor.display->files());
  const bool wants_raw = std::any_of(options.outputs.begin(), options.outputs.end(), is_raw_file);
  if (wants_raw && !sensor.readout)
    throw Error(ErrorCode::usage, "-o",
                "the film has no read-out to make codes with (allowed: --set '/readout={...}', or a .exr)");
  require_noise(sensor, options);
  if (!options.display.empty()) require_display(sensor);
  Diagnostics warnings;
  expose_anew(exposed, options, warnings);
  if (!options.frame) check(warnings);  // of what a frame does not see
  set_field(exposed.sensor, options);
  if (const auto dark = wants_raw ? own_dark_signals(sensor) : std::nullopt) say("warning: " + *dark);

  // At most three planes beside each of the film and of its variance.
  inputs.take_memory("developing", 3 * exposed.film.memory_bytes());
  print(json_of(sensor, develop_frames(exposed, options)), options.json);
  return 0;
}

}  // namespace abbe::cli
