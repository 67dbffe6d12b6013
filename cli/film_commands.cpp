#include "cli/command_options.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli/develop.h"
#include "cli/measure.h"

namespace abbe::cli {
namespace {

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
  options
      .add_option("--exposure-of", settings.exposure_of,
                  "Film whose display exposure the pictures use, as this command would choose it; for "
                  "example the first of several frames")
      ->excludes("--exposure")
      ->type_name("FILE.exr");
  options.add_flag("--field", settings.flattens_field,
                   "Balance white at every position of the field, for filters that respond differently to "
                   "oblique light (default: at its centre)");
  options
      .add_option("--white", settings.white,
                  "White of the pictures, as output/white of a scene (default: the film's)")
      ->type_name("NAME|[X,Y]");
  options
      .add_option("--screen", settings.view.display,
                  "Display of the OpenColorIO configuration (default: its first)")
      ->type_name("NAME");
  options.add_option("--view", settings.view.view, "View of that display (default: its first)")
      ->type_name("NAME");
  options
      .add_option("--ocio", settings.view.config,
                  "OpenColorIO configuration of the pictures (default: $OCIO, otherwise Abbe's own)")
      ->type_name("FILE.ocio");
}

ChartCorners parse_corners(const std::string& option, const std::string& text) {
  if (text == "find") return FindCorners{};
  const std::vector<double> numbers = parse_numbers(option, text, -1e6, 1e6);
  if (numbers.size() != 8)
    throw Error(ErrorCode::usage, option,
                fmt::format("expected x and y of four corners (got {} numbers, allowed 8)", numbers.size()));
  return std::array{Imath::V2d(numbers[0], numbers[1]), Imath::V2d(numbers[2], numbers[3]),
                    Imath::V2d(numbers[4], numbers[5]), Imath::V2d(numbers[6], numbers[7])};
}

}  // namespace

void add_develop(CLI::App& app, Command& command) {
  const Subcommand<DevelopOptions> sub(
      app, "develop", "Convert a film to digital numbers, raw files and pictures, without rendering", command,
      develop);
  CLI::App& options = *sub.app;
  options.add_option("film", sub->film, "Film of render, multi-part film of develop, or spectral image")
      ->required()
      ->type_name("FILE.exr");
  options
      .add_option("-o,--output", sub->outputs,
                  "Raw file of the digital numbers, or .exr of all planes from the exposure to the preview; "
                  "may be repeated")
      ->allow_extra_args(false)
      ->type_name("FILE.dng|FILE.tif|FILE.fits|FILE.png|FILE.exr");
  options.add_option("--display", sub->display, "Write a picture for a display (default: sRGB)")
      ->type_name("FILE.png");
  options
      .add_option("--stokes", sub->polarisation,
                  "Folder for pictures of the degree and angle of polarisation, and for their values (.exr)")
      ->type_name("FOLDER");
  options
      .add_option("--profile", sub->profile,
                  "Calibration for two illuminants by calibrate, whose matrices a .dng contains (default: "
                  "the film's own matrix for its white)")
      ->type_name("dng.json");
  options.add_option("--scene", sub->scene, "Scene whose camera and sensor record a spectral image")
      ->type_name("SCENE");
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

void add_measure(CLI::App& app, Command& command) {
  const Subcommand<MeasureOptions> sub(
      app, "measure", "Measure the patches of a chart in films, raw files and pictures", command, measure);
  CLI::App& options = *sub.app;
  options
      .add_option("images", sub->images,
                  "Films, spectral films, raw files (.dng, .fits, .tif, .png) and other pictures")
      ->required()
      ->type_name("FILE");
  options
      .add_option("--chart", sub->chart,
                  "Scene with the chart, whose camera gives the position of the chart; with --corners, table "
                  "of its patches")
      ->required()
      ->type_name("SCENE|TABLE");
  CLI::Option* corners = add_parsed(options, "--corners", sub->corners, parse_corners,
                                    "Top left, top right, bottom right and bottom left corner of the chart "
                                    "in pixels; find detects a ColorChecker in each image",
                                    "X,Y,X,Y,X,Y,X,Y|find");
  add_parsed(options, "--columns", sub->columns, integer_in<std::size_t>(1, 1000),
             "Patches per row of the chart (default 6)", "N")
      ->needs(corners);
  options
      .add_option("--flat", sub->flat,
                  "Picture of a uniform surface for flat-fielding, by which each pixel is divided")
      ->type_name("FILE");
  options
      .add_option("-o,--output", sub->output,
                  "Table of the patches to write, as calibrate --measured reads it")
      ->type_name("FILE.csv");
  add_max_memory(options, sub.options);
  add_json(options, sub->json);
}

}  // namespace abbe::cli
