#include "cli/commands.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/bench.h"
#include "cli/calibrate.h"
#include "cli/command_options.h"
#include "cli/compare.h"
#include "cli/convert.h"
#include "cli/film_commands.h"
#include "cli/info.h"
#include "cli/material_commands.h"
#include "cli/merge.h"
#include "cli/ray_commands.h"
#include "cli/render_commands.h"
#include "cli/slurm_help.h"
#include "cli/usage.h"
#include "cli/validate.h"
#include "cli/version.h"
#include "description/scene.h"
#include "io/schema/help.h"

namespace abbe::cli {
namespace {

void add_info(CLI::App& app, Command& command) {
  const Sub<InfoOptions> sub(app, "info", "Say what a scene contains, needs and skips", command, info);
  sub.app->add_option("scene", sub->scene, "Scene file, or - for standard input")
      ->required()
      ->type_name("SCENE");
  add_overrides(*sub.app, sub.options);
  add_max_memory(*sub.app, sub.options);
  add_json(*sub.app, sub->json);
}

void add_merge(CLI::App& app, Command& command) {
  const Sub<MergeOptions> sub(app, "merge", "Add up parts of one render", command, merge);
  sub.app->add_option("parts", sub->parts, "Parts, in any order")->required()->type_name("PART.abbepart...");
  sub.app->add_option("-o,--output", sub->outputs, "Film to write, or its exact sums; may be repeated")
      ->required()
      ->allow_extra_args(false)
      ->type_name("FILE.exr|FILE.abbepart");
  sub.app->add_option("--display", sub->display, "Also write a picture for displays, as render does")
      ->type_name("FILE.png");
  add_parsed(
      *sub.app, "--crop", sub->crop,
      [](const auto& option, const auto& text) { return parse_crop(option, text); },
      "Make the film of these pixels (default: of all)", "X0,Y0,X1,Y1");
  sub.app->add_flag("--partial", sub->partial,
                    "Write the film though samples are missing of those that --spp or the scene states");
  add_max_memory(*sub.app, sub.options);
}

void add_convert(CLI::App& app, Command& command) {
  const Sub<ConvertOptions> sub(
      app, "convert",
      "Write a scene file in canonical form, without its comments and what is as "
      "by default, or a scene of pbrt (.pbrt), of Mitsuba (.xml) or of glTF (.gltf, .glb) as a scene file",
      command, convert);
  sub.app->add_option("scene", sub->scene, "Scene file, of another renderer too, or - for standard input")
      ->required()
      ->type_name("SCENE");
  sub.app
      ->add_option("-o,--output", sub->output,
                   "File to write, in the scene's folder if it names files (default: - for standard output)")
      ->type_name("FILE.json");
  sub.app
      ->add_option("--materials", sub->materials,
                   "Materials by name, {NAME: MATERIAL, ...} as scene files have them, in place of those of "
                   "another renderer's scene")
      ->type_name("FILE.json");
  add_overrides(*sub.app, sub.options);
  add_max_memory(*sub.app, sub.options);
}

// How `calibrate` fits and judges colours.
void add_characterisation(CLI::App& options, CharacterisationOptions& how) {
  std::vector<std::string> models(kCorrectionNames.begin(), kCorrectionNames.end());
  models.emplace_back("auto");
  options
      .add_option_function<std::string>(
          "--correction",
          [&how, models](const std::string& text) {
            (void)choose_correction(how, models[parse_choice("--correction", text, models)]);
          },
          "From camera values to colour, auto taking what shows unseen patches best (default matrix)")
      ->type_name(fmt::format("{}", fmt::join(models, "|")));
  add_parsed(options, "--objective", how.fit.objective, one_of<Objective>({"dE2000", "dE76", "XYZ"}),
             "What the fit makes small (default dE2000)", "dE2000|dE76|XYZ");
  add_parsed(options, "--adaptation", how.adaptation, one_of<Adaptation>({"bradford", "cat02", "cat16"}),
             "From the light's white to D65 (default bradford)", "bradford|cat02|cat16");
  add_parsed(options, "--folds", how.folds, integer_in<std::size_t>(2, 100000),
             "Of the cross-validation (default: one patch left out at a time)", "N");
}

void add_compare(CLI::App& app, Command& command) {
  const Sub<CompareOptions> sub(app, "compare", "Compare an image with a reference", command, compare);
  sub.app->add_option("image", sub->image, "Image")->required()->type_name("FILE.exr");
  sub.app->add_option("reference", sub->reference, "Reference; with --chart, the chart's own spectra without")
      ->type_name("FILE.exr");
  sub.app->add_option("--chart", sub->chart, "Also compare patch by patch: the scene with the chart")
      ->type_name("SCENE");
  add_parsed(*sub.app, "--delta-e", sub->formula, one_of<DeltaE>({"2000", "94", "76", "cam16", "itp"}),
             "Formula of colour difference (default 2000)", "2000|94|76|cam16|itp");
  sub.app
      ->add_option("--white", sub->white,
                   "What both images show as white, as output/white of a scene (default: what they tell)")
      ->type_name("NAME|[X,Y]");
  sub.app->add_option("--maps", sub->maps, "Folder for maps and histograms of the differences")
      ->type_name("FOLDER");
  add_max_memory(*sub.app, sub.options);
  add_json(*sub.app, sub->json);
}

// Options of `calibrate` beside which others would have no effect are refused.
void exclude_without_effect(CLI::App& calibrate) {
  const auto option = [&calibrate](const std::string& name) { return calibrate.get_option(name); };
  CLI::Option* const measured = option("--measured");
  CLI::Option* const series = option("--series");
  CLI::Option* const all = option("--all-cameras");
  // Only a simulated camera can look at another chart or be given a response.
  for (const char* simulated : {"--test", "--response", "--bits"})
    option(simulated)->excludes(measured)->excludes(series)->excludes(all);
  std::vector<CLI::Option*> of_colors;
  for (const char* name :
       {"--training", "--correction", "--objective", "--adaptation", "--folds", "--transfer", "--mtf"})
    of_colors.push_back(option(name)->excludes(all));
  option("--output")->excludes(all);
  for (const char* name : {"--illuminant", "--chart"}) of_colors.push_back(option(name));
  // Without values of a chart a series tells of curves, not of colours.
  calibrate.parse_complete_callback([series, measured, of_colors] {
    if (series->count() == 0 || measured->count() > 0) return;
    for (const CLI::Option* color : of_colors)
      if (color->count() > 0) throw CLI::RequiresError(color->get_name(), measured->get_name());
  });
}

void add_calibrate(CLI::App& app, Command& command) {
  const Sub<CalibrateOptions> calibration(app, "calibrate", "Calibrate a camera on a colour chart", command,
                                          calibrate);
  CLI::App& options = *calibration.app;
  CLI::Option* const camera =
      options
          .add_option("--camera", calibration->camera,
                      "Camera or FILE.csv or .json, box:LOW-HIGH,LOW-HIGH,LOW-HIGH, or observer:1931 or 1964")
          ->type_name("CAMERA");
  add_response(options, "--camera-response", calibration->camera_response)->needs(camera);
  options
      .add_option("--measured", calibration->measured,
                  "A real camera's values of the chart, linear or to be made so by --series")
      ->type_name("FILE.csv");
  options
      .add_option("--series", calibration->series,
                  "Photographs with their exposure times, which the response is recovered from")
      ->type_name("FILE.json");
  options.add_flag("--all-cameras", calibration->all_cameras,
                   "How well each shipped camera can be calibrated");
  options
      .add_option("--illuminant", calibration->illuminants, "Light on the chart, or several with --camera")
      ->capture_default_str()
      ->type_name("ILLUMINANT[,...]");
  options
      .add_option("--chart", calibration->chart,
                  "Table of patch reflectances, or of measured patches' colours")
      ->capture_default_str()
      ->type_name("TABLE");
  options.add_option("--test", calibration->test, "Another chart to try the correction on")
      ->type_name("TABLE");
  options
      .add_option(
          "--training", calibration->training,
          "Reflectances to fit the correction to instead of the chart, seen through the camera's curves")
      ->type_name("TABLE[,TABLE...]");
  options
      .add_option("--response", calibration->planted_response,
                  "Response to be recovered: linear, gamma:G or s-curve (default: linear, known)")
      ->type_name("CURVE");
  add_parsed(options, "--bits", calibration->bits, integer_in<int>(0, 16),
             "Of the code values, 0 for no rounding (default 12)", "N");
  add_characterisation(options, calibration->how);
  options
      .add_option("-o,--output", calibration->output,
                  "Folder for the OpenColorIO configuration, CLF, ACES input transform and report")
      ->type_name("FOLDER");
  options
      .add_option("--transfer", calibration->transfer, "What transfer --json has said, for the report's page")
      ->type_name("FILE.json");
  options.add_option("--mtf", calibration->mtf, "What mtf --json has said, for the same")
      ->type_name("FILE.json");
  exclude_without_effect(options);
  add_max_memory(options, calibration.options);
  add_json(options, calibration->json);
}

// What `bench` does instead of measuring suites is asked for alone, but for what has an effect on it.
void exclude_beside_other_benches(CLI::App& bench) {
  const auto option = [&bench](const std::string& name) { return bench.get_option(name); };
  CLI::Option* const list = option("--list");
  CLI::Option* const scale = option("--scale");
  CLI::Option* const soak = option("--soak");
  for (const char* name : {"suite", "--integrator", "--spp", "--seeds", "--reference-spp", "--baseline"})
    option(name)->excludes(list)->excludes(scale)->excludes(soak);
  for (const char* name : {"--threads", "--quick"}) option(name)->excludes(list)->excludes(soak);
  option("--output")->excludes(list)->excludes(scale);
  option("--cache")->excludes(list);
  scale->excludes(list)->excludes(soak);
  soak->excludes(list);
  option("--strict")->needs(option("--baseline"));
  option("--seed")->needs(soak);
}

void add_bench(CLI::App& app, Command& command) {
  const Sub<BenchOptions> sub(app, "bench", "Measure run time against error", command, bench);
  CLI::App& options = *sub.app;
  options.add_option("suite", sub->suites, "Scenes to measure (default: all)")->type_name("SUITE");
  options.add_option("-o,--output", sub->output, "Folder for tables and plots")->type_name("FOLDER");
  add_parsed(
      options, "--integrator", sub->integrators, parse_integrators,
      "Techniques that render each suite by turns, and are compared if there are several (default auto)",
      "NAME[,NAME...]");
  add_parsed(options, "--spp", sub->samples, parse_sample_counts, "Samples per pixel (default 4,8,16,32,64)",
             "N[,N...]");
  add_parsed(options, "--seeds", sub->seeds, integer_in<int>(1, 1000), "Renders of each (default 3)", "N");
  add_parsed(options, "--threads", sub->threads, integer_in<int>(0, kMaxThreads),
             "Threads, 0 for one per processor", "N");
  add_parsed(options, "--reference-spp", sub->reference_samples, integer_in<int>(2, kMaxSamples),
             "Of the references (default: 64 times the most of --spp)", "N");
  options.add_option("--baseline", sub->baseline, "A bench.json to compare with")->type_name("FILE.json");
  options.add_option("--cache", sub->cache, "Where references are kept (default ~/.cache/abbe/bench)")
      ->type_name("FOLDER");
  options.add_flag("--quick", sub->quick, "Small films, compared with no rival");
  options.add_flag("--strict", sub->strict, "Exit with 1 when something got worse than the baseline");
  options.add_flag("--scale", sub->scale, "Measure instead what scenes of growing size cost");
  add_parsed(options, "--soak", sub->soak_paths, integer_in<std::uint64_t>(1, kMaxSeed),
             "Look instead, over so many paths, whether anything goes wrong in scenes drawn at random", "N");
  add_parsed(options, "--seed", sub->soak_seed, integer_in<std::uint64_t>(0, kMaxSeed),
             "Of the first scene of a soak, the next ones count on (default 0)", "N");
  options.add_flag("--list", sub->list, "Say what suites there are");
  exclude_beside_other_benches(options);
  add_json(options, sub->json);
}

void add_validate(CLI::App& app, Command& command) {
  const Sub<ValidateOptions> sub(app, "validate", "Recompute everything that has a known answer", command,
                                 validate);
  CLI::App& options = *sub.app;
  options.add_flag("--quick", sub->quick, "Films at wider margins, within two minutes");
  add_parsed(options, "--suite", sub->suites, parse_suites,
             "Only some of optics, radiometry, colour, camera, sensor and techniques", "SUITE[,SUITE...]");
  options.add_option("-o,--output", sub->output, "Folder for report.html and report.json")
      ->type_name("FOLDER");
  add_parsed(options, "--threads", sub->threads, integer_in<int>(0, kMaxThreads),
             "Threads, 0 for one per processor", "N");
  add_json(options, sub->json);
}

std::string help_text(const CLI::App& app, const std::string& topic, const std::string& key) {
  if (topic == "scene") return schema::help(schema::fields_of<spec::Scene>(), key);
  if (topic == "slurm") return slurm_help(key);
  if (!key.empty()) throw Error(ErrorCode::usage, key, "only help scene and help slurm take another word");
  return topic.empty() ? help_of(app, "abbe") : help_of(find_command(app, topic), "abbe " + topic);
}

// `abbe help [COMMAND]`, `abbe help scene [KEY]` and `abbe help slurm [FILE]`.
void add_help(CLI::App& app, Command& command) {
  struct Options {
    std::string command;
    std::string key;
    std::optional<ReferenceFormat> format;
  };
  CLI::App* help = app.add_subcommand("help", "Show how to use Abbe, one command, or a key of scene files");
  auto options = std::make_shared<Options>();
  CLI::Option* name =
      help->add_option(
              "command", options->command,
              "Command, scene for the keys of scene files, or slurm for the jobs of a render in parts")
          ->type_name("COMMAND|scene|slurm");
  help->add_option(
          "key", options->key,
          "With scene: a key, wherever it may stand, or a path of keys, as sensor/readout; with slurm: "
          "a file, to be printed alone")
      ->type_name("KEY");
  add_parsed(*help, "--format", options->format, one_of<ReferenceFormat>({"markdown", "man", "bash"}),
             "Write the reference of all commands", "markdown|man|bash")
      ->excludes(name);
  help->callback([&app, &command, options] {
    command = [&app, options] {
      fmt::print("{}", options->format ? reference(usage_of(app, "abbe"), *options->format)
                                       : help_text(app, options->command, options->key));
      return 0;
    };
  });
}

}  // namespace

void add_commands(CLI::App& app, Command& command) {
  app.set_version_flag("--version", version_text, "Show the version, the data and the libraries");
  app.require_subcommand(1);
  add_render(app, command);
  add_meter(app, command);
  add_merge(app, command);
  add_convert(app, command);
  add_info(app, command);
  add_trace(app, command);
  add_draw(app, command);
  add_lens(app, command);
  add_query(app, command);
  add_lab(app, command);
  add_develop(app, command);
  add_measure(app, command);
  add_compare(app, command);
  add_calibrate(app, command);
  add_transfer(app, command);
  add_mtf(app, command);
  add_validate(app, command);
  add_bench(app, command);
  add_help(app, command);
  refuse_empty_values(app);
}

}  // namespace abbe::cli
