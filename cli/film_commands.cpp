#include "cli/film_commands.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli/develop.h"
#include "cli/measure.h"

namespace abbe::cli {
namespace {

// How `develop` exposes a film anew, or what it sees instead.
void add_exposure(CLI::App& options, DevelopOptions& how) {
  add_parsed(
      options, "--exposure-s", how.exposure_s, number_in(1e-12, 1e9),
      "Expose anew for this time in s, without rendering: that of all channels, or where they differ the "
      "sensor's, to which theirs keep their ratio; what moves stays blurred as in the film's own",
      "T");
  options
      .add_option_function<std::vector<std::string>>(
          "--light",
          [&how](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) how.lights.push_back(parse_light_factor("--light", text));
          },
          "Let a light of a film with layers of lights count so many times, or so many for each plane; may "
          "be "
          "repeated")
      ->allow_extra_args(false)
      ->type_name("NAME=FACTOR[,...]");
  add_parsed(options, "--frame", how.frame, parse_calibration_frame,
             "See no scene: bias is the read-out alone, dark the film's own time without light, flat even "
             "light of this share of saturation (default 0.5)",
             "bias|dark|flat[:SHARE]");
  add_parsed(options, "--frames", how.frames, integer_in<std::uint32_t>(1, 9999),
             "Exposures with noise of their own, numbered in the names of their files", "N");
  add_parsed(options, "--iso", how.iso, number_in(1e-12, 1e9), "ISO speed in place of the gain", "N");
}

// How `develop` shows a film.
void add_showing(CLI::App& options, DevelopOptions& how) {
  add_parsed(options, "--exposure", how.display_exposure, number_in(1e-30, 1e30),
             "Film value shown as white (default: the scene's, else chosen from the image)", "X");
  options
      .add_option(
          "--exposure-of", how.exposure_of,
          "Show pictures with the exposure that this command chooses for another film, as the first of "
          "several frames")
      ->excludes("--exposure")
      ->type_name("FILE.exr");
  options.add_flag("--field", how.flattens_field,
                   "Balance white over the whole field, where filters respond otherwise to oblique light "
                   "(default: for its centre)");
  options
      .add_option("--white", how.white,
                  "What pictures show as white, as output/white of a scene (default: the film's)")
      ->type_name("NAME|[X,Y]");
  options.add_option("--screen", how.view.display, "Display of the configuration (default: its first)")
      ->type_name("NAME");
  options.add_option("--view", how.view.view, "View on that display (default: its first)")->type_name("NAME");
  options
      .add_option("--ocio", how.view.config, "OpenColorIO configuration (default: $OCIO, else Abbe's own)")
      ->type_name("FILE.ocio");
}

}  // namespace

void add_develop(CLI::App& app, Command& command) {
  const Sub<DevelopOptions> sub(app, "develop", "Read a film out and show it, without rendering", command,
                                develop);
  CLI::App& options = *sub.app;
  options.add_option("film", sub->film, "Film, as rendered or developed into parts, or spectral image")
      ->required()
      ->type_name("FILE.exr");
  options
      .add_option("-o,--output", sub->outputs,
                  "Codes of the sensor, or all planes from exposure to preview (.exr); may be repeated")
      ->allow_extra_args(false)
      ->type_name("FILE.dng|FILE.tif|FILE.fits|FILE.png|FILE.exr");
  options.add_option("--display", sub->display, "Write a picture for sRGB displays")->type_name("FILE.png");
  options
      .add_option("--stokes", sub->polarisation,
                  "Folder for pictures of the degree and the angle of polarisation, and their values (.exr)")
      ->type_name("FOLDER");
  options
      .add_option("--profile", sub->profile,
                  "Matrices of a calibration for two lights, which a .dng tells raw converters (default: the "
                  "film's own for its white)")
      ->type_name("dng.json");
  options.add_option("--scene", sub->scene, "Scene whose camera and sensor look at a spectral image")
      ->type_name("SCENE");
  add_exposure(options, *sub.options);
  add_showing(options, *sub.options);
  add_overrides(options, sub.options,
                "Replace a value of the read-out, as /readout/bits=12, or /output/white; may be repeated");
  add_parsed(options, "--seed", sub->seed, integer_in<std::uint64_t>(0, kMaxSeed),
             "Seed of the noise (default: the render's)", "N");
  add_max_memory(options, sub.options);
  add_json(options, sub->json);
}

namespace {

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

void add_measure(CLI::App& app, Command& command) {
  const Sub<MeasureOptions> sub(
      app, "measure", "Measure the patches of a chart in films, raw files and pictures", command, measure);
  CLI::App& options = *sub.app;
  options
      .add_option("images", sub->images,
                  "Films, spectral films, raw files (.dng, .fits, .tif, .png) and other pictures")
      ->required()
      ->type_name("FILE");
  options
      .add_option("--chart", sub->chart,
                  "Scene with the chart, whose camera says where it is; with --corners, table of its patches")
      ->required()
      ->type_name("SCENE|TABLE");
  CLI::Option* corners =
      add_parsed(options, "--corners", sub->corners, parse_corners,
                 "Where the chart's top left, top right, bottom right and bottom left corner are, in pixels; "
                 "find: wherever a ColorChecker is found in each image",
                 "X,Y,X,Y,X,Y,X,Y|find");
  add_parsed(options, "--columns", sub->columns, integer_in<std::size_t>(1, 1000),
             "Patches in a row of the chart (default 6)", "N")
      ->needs(corners);
  options.add_option("--flat", sub->flat, "Picture of an even surface, by which each pixel is divided")
      ->type_name("FILE");
  options.add_option("-o,--output", sub->output, "Table of the patches, as calibrate --measured takes it")
      ->type_name("FILE.csv");
  add_max_memory(options, sub.options);
  add_json(options, sub->json);
}

}  // namespace abbe::cli
