#include <algorithm>
#include <array>
#include <deque>
#include <functional>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "calibration/output/camera_profile.h"
#include "cli/answer.h"
#include "cli/command_options.h"
#include "cli/output_files.h"
#include "develop/develop.h"
#include "develop/film_file.h"
#include "develop/film_sensor.h"
#include "develop/polarisation.h"
#include "develop/radiance.h"
#include "develop/raw_picture.h"
#include "develop/relight.h"
#include "io/atomic_file.h"
#include "io/error.h"
#include "io/exr.h"
#include "io/picture.h"
#include "io/text.h"
#include "report/maps.h"
#include "results/spectral.h"
#include "results/white.h"
#include "sensor/film/recorded_attributes.h"
#include "sensor/readout/speed.h"

namespace abbe::cli {
namespace {

namespace fs = std::filesystem;

struct DevelopOptions {
  fs::path film;
  std::vector<fs::path> outputs;
  fs::path display;
  fs::path polarisation;
  fs::path scene;
  std::vector<Override> overrides;
  std::optional<std::string> white;
  std::vector<LightFactor> lights;
  std::optional<double> exposure_s;
  std::optional<double> iso;
  std::optional<CalibrationFrame> frame;
  std::uint32_t frames = 1;
  std::optional<double> display_exposure;
  fs::path exposure_of;
  bool flattens_field = false;
  ViewOptions view;
  fs::path profile;
  std::optional<std::uint64_t> seed;
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;
};

// File of one of several exposures, numbered from 1: "dark_0003.tif".
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

// Files of the polarisation maps and values. Creates their folder.
std::vector<fs::path> polarisation_files(const DevelopOptions& options) {
  if (options.polarisation.empty()) return {};
  std::error_code ignored;
  fs::create_directories(options.polarisation, ignored);
  std::vector<fs::path> files{values_file(options)};
  for (const char* map : {kDegreeMap, kLinearDegreeMap, kAngleMap}) files.push_back(map_file(options, map));
  return files;
}

bool overrides_pointer(const DevelopOptions& options, std::string_view pointer) {
  return std::ranges::any_of(options.overrides,
                             [pointer](const Override& o) { return o.pointer == pointer; });
}

// Rejects options that have no effect because of others.
void require_effect(const DevelopOptions& options) {
  const auto reject = [](const char* option, std::string_view why) {
    throw Error(ErrorCode::usage, option, std::string(why));
  };
  const auto reject_override = [&](const char* option, std::string_view pointer) {
    if (overrides_pointer(options, pointer))
      reject(option, fmt::format("sets the same value as --set {}: give only one of them", pointer));
  };
  if (options.iso) reject_override("--iso", kIsoPointer);
  if (options.white) reject_override("--white", kWhitePointer);
  const char* display_option = options.display_exposure                    ? "--exposure"
                               : !options.exposure_of.empty()              ? "--exposure-of"
                               : options.flattens_field                    ? "--field"
                               : options.white                             ? "--white"
                               : overrides_pointer(options, kWhitePointer) ? kWhitePointer
                                                                           : "";
  if (*display_option != 0 && options.display.empty() && options.outputs.empty())
    reject(display_option, "has no effect without an output (allowed with --display or -o)");
  if (!options.frame) return;
  if (!options.lights.empty())
    reject(
        "--light",
        "has no effect on a calibration frame, which does not contain the scene (allowed without --frame)");
  if (options.exposure_s && std::holds_alternative<BiasFrame>(*options.frame))
    reject("--exposure-s",
           "has no effect on a bias frame, whose exposure time is zero (allowed with --frame dark or flat)");
}

// Checks options and outputs before anything is read, and returns the files that will be written.
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

// View of the picture. The configuration in $OCIO is ignored if no picture is written.
ViewOptions view_of(const DevelopOptions& options) {
  if (options.display.empty()) return {};
  ViewOptions view = options.view;
  if (view.config.empty()) view.config = users_configuration();
  return view;
}

// Requested white, from --white or the last --set, and the other overrides.
struct RequestedChanges {
  std::optional<std::string> white;
  std::vector<Override> overrides;
};
RequestedChanges requested_changes(const DevelopOptions& options) {
  RequestedChanges all{options.white, {}};
  for (const Override& o : options.overrides)
    if (o.pointer == kWhitePointer)
      all.white = o.value;
    else
      all.overrides.push_back(o);
  if (options.iso) all.overrides.push_back({kIsoPointer, fmt::format("{}", *options.iso), "--iso"});
  return all;
}

// Option that requests the white, for error messages.
const char* white_option(const DevelopOptions& options) {
  return options.white ? "--white" : "--set";
}

FilmSensor sensor_of(const Image& film, const fs::path& path, const std::vector<Override>& overrides,
                     const DevelopOptions& options, const std::optional<White>& white = {}) {
  Diagnostics diagnostics;
  const auto xy = white ? std::optional(white->xy) : std::nullopt;
  FilmSensor sensor =
      accepted(read_film_sensor(film, path, overrides, view_of(options), xy, diagnostics), diagnostics);
  if (white) sensor.white_name = white->name;
  require_planes(film, sensor, options.film);
  return sensor;
}

// Film of a spectral image: exposed on the sensor of a scene, or as recorded by an observer.
ExposedFilm expose_spectral(Image file, const DevelopOptions& options, Inputs& inputs) {
  const auto [white, overrides] = requested_changes(options);
  Image header{0, 0, {}, file.metadata};
  for (const ImageChannel& channel : file.channels) header.channels.push_back({channel.name, {}});
  const SpectralImage image = spectral_image(std::move(file), options.film.string());
  if (!options.scene.empty()) {
    Diagnostics diagnostics;
    std::optional<Scene> scene = load_scene(options.scene, {}, diagnostics, &inputs);
    if (!scene) check(diagnostics);  // its warnings concern renders only
    resolve_white(*scene, options.scene, header, white, white_option(options));
    Diagnostics band_diagnostics;
    Image film = expose_radiances(*scene, image, options.film, band_diagnostics);
    check(band_diagnostics);
    FilmSensor sensor = sensor_of(film, options.scene, overrides, options);
    return {std::move(film), std::move(sensor)};
  }
  const char* unsupported = !options.outputs.empty() ? "-o"
                            : options.iso            ? "--iso"
                            : !overrides.empty()     ? "--set"
                                                     : "";
  if (*unsupported != 0)
    throw Error(ErrorCode::usage, unsupported, "needs a sensor for a spectral film (allowed with --scene)");
  if (!white) return observed_film(image, options.film, view_of(options), {});
  const White chosen = requested_white(*white, header, white_option(options));
  ExposedFilm exposed = observed_film(image, options.film, view_of(options), chosen.xy);
  exposed.sensor.white_name = chosen.name;
  return exposed;
}

// Writes the polarisation that a film records, in Stokes planes or in channels behind polarisers.
void write_polarisation(const Image& film, const DevelopOptions& options) {
  const Image solved = stokes_planes(film).empty() ? stokes_of_polarisers(film) : Image{};
  const Image& measured = solved.channels.empty() ? film : solved;
  Image values = polarisation_image(measured);
  values.channels.insert(values.channels.end(), solved.channels.begin(), solved.channels.end());
  const std::vector<PolarisationMap> maps = polarisation_maps(
      polarisation_of_light(measured), solved.channels.empty() ? MeasuredStokes::all : MeasuredStokes::linear,
      film.width, film.height);
  std::vector<std::function<void()>> writers;
  writers.emplace_back([&] { write_exr(values_file(options), values); });
  for (const PolarisationMap& map : maps)
    writers.emplace_back([&] { write_picture(map_file(options, map.name), map.map); });
  write_all(writers);
}

// Applies the factors of --light to the film. Returns the white of the weighted lights if it differs from
// that of the film and no other white is requested.
std::optional<White> apply_light_factors(Image& film, const DevelopOptions& options) {
  if (options.lights.empty()) return std::nullopt;
  const RelitWhite relit =
      requested_changes(options).white ? RelitWhite{} : relit_white(film, options.lights);
  if (!relit.warning.empty()) print_message("warning: --light: " + relit.warning);
  relight(film, options.lights);
  return relit.white;
}

ExposedFilm load(const DevelopOptions& options, Inputs& inputs) {
  Image film = read_film(options.film, &inputs);
  const std::optional<White> relit = apply_light_factors(film, options);
  if (!options.polarisation.empty()) write_polarisation(film, options);
  if (is_spectral(film)) {
    if (relit) record_white(relit->name, relit->xy, relit->requested, film.metadata);
    return expose_spectral(std::move(film), options, inputs);
  }
  if (!options.scene.empty())
    throw Error(ErrorCode::usage, "--scene", "applies to spectral films only: this film has its own sensor");
  const auto [white, overrides] = requested_changes(options);
  const auto chosen = white ? std::optional(requested_white(*white, film, white_option(options))) : relit;
  FilmSensor sensor = sensor_of(film, options.film, overrides, options, chosen);
  return {std::move(film), std::move(sensor)};
}

/// Figures that `develop` reports about the first exposure.
struct Report {
  std::vector<PlaneFigures> planes;
  std::optional<double> display_white;  ///< Absent if no display can show the film.
};

Json json_of(const FilmSensor& sensor, const Report& report) {
  const std::vector<PlaneFigures>& planes = report.planes;
  Json answer;
  answer["planes"] = sensor.planes;
  for (const PlaneFigures& plane : planes) {
    const Json render_error = or_null(plane.render_error);
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
    answer["saturated_share"].push_back(plane.saturated_fraction);
  }
  if (sensor.readout && sensor.electrons_per_lx_s)
    answer["iso_speed"] = saturation_speed(*sensor.readout, *sensor.electrons_per_lx_s);
  if (!sensor.camera_space.empty()) answer["camera_space"] = sensor.camera_space;
  if (report.display_white) answer[kDisplayExposureKey] = *report.display_white;
  return answer;
}

// Applies --exposure-s, --frame and --exposure. `diagnostics` receives warnings about the scene of the film.
void apply_exposure(ExposedFilm& exposed, const DevelopOptions& options, Diagnostics& diagnostics) {
  if (options.exposure_s) expose_for(exposed, *options.exposure_s, diagnostics);
  if (options.frame) replace_with_frame(exposed, *options.frame);
  if (options.display_exposure) exposed.sensor.display_exposure = options.display_exposure;
}

// Applies --field, and warns of neutral surfaces that are tinted without it.
void set_field(FilmSensor& sensor, const DevelopOptions& options) {
  sensor.flattens_field = options.flattens_field;
  if (!sensor.white_field || !sensor.display || options.frame) {
    if (options.flattens_field)
      print_message(
          "warning: --field: has no effect, since the response of the channels to white does not vary over "
          "the field or is not recorded in the film");
    return;
  }
  const std::string remedy =
      options.outputs.empty() ? "--field balances pictures over the field"
                              : "--field balances pictures over the field, and raw files need a flat field";
  const double shift = neutral_shift(*sensor.white_field, sensor.display->to_xyz_d65());
  const bool is_flat = options.flattens_field && options.outputs.empty();
  if (!is_flat) warn(field_tint_warning(shift, remedy));
}

// Adds the lights of --profile to the sensor of a DNG.
void add_profile(FilmSensor& sensor, const DevelopOptions& options, Inputs& inputs) {
  if (options.profile.empty()) return;
  const auto is_dng = [](const fs::path& path) { return extension_of(path) == ".dng"; };
  if (std::ranges::none_of(options.outputs, is_dng))
    throw Error(ErrorCode::usage, "--profile", "applies to .dng files only (allowed with -o FILE.dng)");
  if (sensor.channels.size() != 3)
    throw Error(ErrorCode::usage, "--profile",
                fmt::format("needs a sensor with three channels (got {})", sensor.channels.size()));
  Diagnostics diagnostics;
  inputs.add_file(options.profile);
  const DngProfile profile = accepted(read_dng_profile(options.profile, diagnostics), diagnostics);
  require_same_camera(profile, sensor, options.profile);
  for (const RawLight& light : profile.lights) sensor.lights.push_back(light_for(sensor.channels, light));
}

// Several exposures and a seed require a readout, since exposures of one film differ by its noise only.
void require_noise(const FilmSensor& sensor, const DevelopOptions& options) {
  const char* unsupported = options.frames > 1 ? "--frames" : options.seed ? "--seed" : "";
  if (*unsupported != 0 && !sensor.readout)
    throw Error(ErrorCode::usage, unsupported,
                "needs a film with a readout, which has the noise (allowed: --set '/readout={...}')");
}

Report report_of(const FilmSensor& sensor, const DevelopedFilm& developed, const Image& planes) {
  Report report{plane_figures(sensor, developed), {}};
  if (sensor.display) report.display_white = display_white(sensor, planes);
  return report;
}

// Develops one exposure and writes all its files, even if one of them fails.
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

// Develops all exposures and returns the figures of the first. A failure is thrown after all files were
// tried.
Report develop_frames(const ExposedFilm& exposed, const DevelopOptions& options) {
  Report report;
  std::vector<std::function<void()>> writers;
  for (std::uint32_t frame = 0; frame < options.frames; ++frame)
    writers.emplace_back([&, frame] {
      Report frame_report = develop_frame(exposed, options, frame);
      if (frame == 0) report = std::move(frame_report);
    });
  write_all(writers);
  return report;
}

// Display exposure that this command would choose for the film of --exposure-of.
double exposure_of_film(const DevelopOptions& options, Inputs& inputs) {
  DevelopOptions other = options;
  other.film = options.exposure_of;
  other.polarisation.clear();
  other.frame.reset();
  Diagnostics warnings;  // the developed film gives the same ones
  ExposedFilm exposed = load(other, inputs);
  require_display(exposed.sensor);
  apply_exposure(exposed, other, warnings);
  exposed.sensor.flattens_field = options.flattens_field;
  const std::uint64_t seed = options.seed.value_or(render_seed(exposed.film));
  return display_white(exposed.sensor,
                       display_planes(exposed.sensor, abbe::develop(exposed, seed).calibrated));
}

// Converts a film to digital numbers, files and pictures without rendering. Prints the sensor's noise and the
// error of the render for the first exposure. All outputs are tried, even if one fails; the first failure is
// thrown then.
void develop(const DevelopOptions& options) {
  const std::vector<fs::path> outputs = check_outputs(options);
  std::deque<FileLock> locks;
  for (const fs::path& file : writable_among(outputs)) locks.emplace_back(file);
  Inputs inputs(options.max_memory_bytes);
  ExposedFilm exposed = load(options, inputs);
  add_profile(exposed.sensor, options, inputs);
  if (!options.exposure_of.empty()) exposed.sensor.display_exposure = exposure_of_film(options, inputs);
  require_distinct(outputs, inputs.files());
  const FilmSensor& sensor = exposed.sensor;
  if (sensor.display) require_distinct(outputs, sensor.display->files());
  const bool wants_raw = std::ranges::any_of(options.outputs, is_raw_file);
  if (wants_raw && !sensor.readout)
    throw Error(
        ErrorCode::usage, "-o",
        "needs a film with a readout to write digital numbers (allowed: --set '/readout={...}', or a .exr)");
  require_noise(sensor, options);
  if (!options.display.empty()) require_display(sensor);
  Diagnostics warnings;
  apply_exposure(exposed, options, warnings);
  if (!options.frame) check(warnings);  // calibration frames do not contain the scene
  set_field(exposed.sensor, options);
  if (wants_raw) warn(unequal_dark_signals_warning(sensor));

  // At most three further planes exist for each plane of the film and of its variance.
  inputs.reserve_memory("developing", 3 * exposed.film.memory_bytes());
  print(json_of(sensor, develop_frames(exposed, options)), options.json);
}

// Adds the options of `develop` for the exposure and for calibration frames.
void add_exposure(CLI::App& options, DevelopOptions& settings) {
  add_parsed(options, "--exposure-s", settings.exposure_s, number_in(1e-12, 1e9),
             "Exposure time to simulate in s, without a new render; channels with their own times keep their "
             "ratio to it, and motion blur stays that of the film",
             "T");
  options
      .add_option_function<std::vector<std::string>>(
          "--light",
          [&settings](const std::vector<std::string>& texts) {
            for (const std::string& text : texts)
              settings.lights.push_back(parse_light_factor("--light", text));
          },
          "Multiply the contribution of a light by a factor >= 0, or by one factor per plane; needs a film "
          "with a layer per light; may be repeated")
      ->allow_extra_args(false)
      ->type_name("NAME=FACTOR[,...]");
  add_parsed(options, "--frame", settings.frame, parse_calibration_frame,
             "Develop a calibration frame instead of the scene: bias (readout only), dark (no light, "
             "exposure time of the film) or flat (uniform light at this fraction of saturation, default 0.5)",
             "bias|dark|flat[:FRACTION]");
  add_parsed(options, "--frames", settings.frames, integer_in<std::uint32_t>(1, 9999),
             "Number of exposures with independent noise, which are numbered in the file names (default 1)",
             "N");
  add_parsed(options, "--iso", settings.iso, number_in(1e-12, 1e9),
             "ISO speed of the sensor, which replaces its gain", "N");
}

// Adds the options of `develop` for pictures.
void add_display(CLI::App& options, DevelopOptions& settings) {
  add_parsed(options, "--exposure", settings.display_exposure, number_in(1e-30, 1e30),
             "Film value that pictures show as white (default: the scene's, otherwise chosen from the film)",
             "X");
  add_value(options, "--exposure-of", settings.exposure_of,
            "Film whose display exposure the pictures use, as this command would choose it; for "
            "example the first of several frames",
            "FILE.exr")
      ->excludes("--exposure");
  options.add_flag("--field", settings.flattens_field,
                   "Balance white at every position of the field, for filters that respond differently to "
                   "oblique light (default: at its centre)");
  add_value(options, "--white", settings.white,
            "White of the pictures, as output/white of a scene (default: the film's)", "NAME|[X,Y]");
  add_value(options, "--screen", settings.view.display,
            "Display of the OpenColorIO configuration (default: its first)", "NAME");
  add_value(options, "--view", settings.view.view, "View of that display (default: its first)", "NAME");
  add_value(options, "--ocio", settings.view.config,
            "OpenColorIO configuration of the pictures (default: $OCIO, otherwise Abbe's own)", "FILE.ocio");
}

}  // namespace

void add_develop(CLI::App& app, Command& command) {
  const Subcommand<DevelopOptions> sub(
      app, "develop", "Convert a film to digital numbers, raw files and pictures, without rendering", command,
      develop);
  CLI::App& options = *sub.app;
  add_value(options, "film", sub->film, "Film of render, multi-part film of develop, or spectral image",
            "FILE.exr")
      ->required();
  add_value(options, "-o,--output", sub->outputs,
            "Raw file of the digital numbers, or .exr of all planes from the exposure to the preview; "
            "may be repeated",
            "FILE.dng|FILE.tif|FILE.fits|FILE.png|FILE.exr")
      ->allow_extra_args(false);
  add_value(options, "--display", sub->display, "Write a picture for a display (default: sRGB)", "FILE.png");
  add_value(options, "--stokes", sub->polarisation,
            "Folder for pictures of the degree and angle of polarisation, and for their values (.exr)",
            "FOLDER");
  add_value(options, "--profile", sub->profile,
            "Calibration for two illuminants by calibrate, whose matrices a .dng contains (default: "
            "the film's own matrix for its white)",
            "dng.json");
  add_value(options, "--scene", sub->scene, "Scene whose camera and sensor record a spectral image", "SCENE");
  add_exposure(options, *sub.options);
  add_display(options, *sub.options);
  add_overrides(
      options, sub.options,
      "Replace a value of the readout, such as /readout/bits=12, or /output/white; may be repeated");
  add_parsed(options, "--seed", sub->seed, integer_in<std::uint64_t>(0, kMaxSeed),
             "Seed of the noise (default: that of the render)", "N");
  add_max_memory(options, sub.options);
  add_json(options, sub->json);
}

}  // namespace abbe::cli
