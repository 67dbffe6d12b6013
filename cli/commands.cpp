#include "cli/commands.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/calibrate.h"
#include "cli/command_options.h"
#include "cli/compare.h"
#include "cli/help.h"
#include "description/scene.h"
#include "io/diagnostics.h"
#include "io/error.h"
#include "io/schema/documentation.h"

namespace abbe::cli {
namespace {

// Error text for an empty value.
std::string no_value(const CLI::Option& option) {
  return fmt::format("got an empty value, allowed {}", option.get_type_name());
}

// Checks an `argument` "--name" or "--name=value".
void check_option(const CLI::App& app, const std::string& argument) {
  const std::size_t equals = argument.find('=');
  const std::string name = argument.substr(0, equals);
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& known : option->get_lnames()) {
      names.push_back("--" + known);
      if (names.back() == name && equals + 1 == argument.size() && option->get_items_expected_max() > 0)
        throw Error(ErrorCode::usage, name, no_value(*option));
    }
  if (std::ranges::find(names, name) == names.end())
    throw Error(ErrorCode::usage, "", unknown_name("option", name, names));
}

std::string names_of(const std::set<CLI::Option*>& options) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options)
    names.push_back(option->nonpositional() ? option->get_name() : option->get_type_name());
  std::ranges::sort(names);  // the set is in the order of addresses
  return fmt::format("{}", fmt::join(names, ", "));
}

// The subcommand of that name. Throws Error{usage} that suggests the nearest name, which CLI11 does not.
const CLI::App& find_command(const CLI::App& app, const std::string& name) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) {
    if (command->get_name() == name) return *command;
    names.push_back(command->get_name());
  }
  throw Error(ErrorCode::usage, "", unknown_name("command", name, names));
}

// Makes every option and argument with a value reject an empty one, including those of subcommands. Empty
// values come from unset variables of scripts and would count as absent options.
void reject_empty_values(CLI::App& app) {
  for (CLI::Option* option : app.get_options())
    if (option->get_items_expected_min() > 0)
      option->check([option](const std::string& value) { return value.empty() ? no_value(*option) : ""; });
  for (CLI::App* command : app.get_subcommands({})) reject_empty_values(*command);
}

// Help text of one command, which is called `name` in it. `app.help()` would show the help of the subcommand
// that was given.
std::string help_of(const CLI::App& app, const std::string& name) {
  return app.get_formatter()->make_help(&app, name, CLI::AppFormatMode::Normal);
}

OptionUsage usage_of(const CLI::Option& option) {
  OptionUsage usage;
  for (const std::string& name : option.get_snames()) usage.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) usage.names.push_back("--" + name);
  if (option.get_items_expected_max() > 0) usage.value = option.get_type_name();
  usage.help = option.get_description();
  if (!option.get_default_str().empty()) usage.help += fmt::format(" (default {})", option.get_default_str());
  if (!option.get_needs().empty()) usage.help += "; only with " + names_of(option.get_needs());
  if (!option.get_excludes().empty()) usage.help += "; not with " + names_of(option.get_excludes());
  usage.required = option.get_required();
  return usage;
}

// All options and arguments of a command, including its subcommands, whose names begin with `name`.
CommandUsage usage_of(const CLI::App& app, const std::string& name) {
  CommandUsage usage{name, app.get_description(), {}, {}};
  for (const CLI::Option* option : app.get_options()) usage.options.push_back(usage_of(*option));
  for (const CLI::App* command : app.get_subcommands({}))
    usage.commands.push_back(usage_of(*command, name + ' ' + command->get_name()));
  return usage;
}

// Adds the options of `calibrate` for the fit of the colour correction.
void add_characterisation(CLI::App& options, CharacterisationOptions& characterisation) {
  std::vector<std::string> models(kCorrectionNames.begin(), kCorrectionNames.end());
  models.emplace_back("auto");
  options
      .add_option_function<std::string>(
          "--correction",
          [&characterisation, models](const std::string& text) {
            (void)choose_correction(characterisation, models[parse_choice("--correction", text, models)]);
          },
          "Model that converts camera values to colours; auto takes the model with the smallest mean error "
          "of patches left out of the fit (default matrix)")
      ->type_name(fmt::format("{}", fmt::join(models, "|")));
  add_parsed(options, "--objective", characterisation.fit.objective,
             one_of<Objective>({"dE2000", "dE76", "XYZ"}),
             "Error that the fit minimises: CIEDE2000, CIE 1976 colour difference or difference of XYZ "
             "(default dE2000)",
             "dE2000|dE76|XYZ");
  add_parsed(options, "--adaptation", characterisation.adaptation,
             one_of<Adaptation>({"bradford", "cat02", "cat16"}),
             "Chromatic adaptation from the white of the illuminant to D65 (default bradford)",
             "bradford|cat02|cat16");
  add_parsed(options, "--folds", characterisation.folds, integer_in<std::size_t>(2, 100000),
             "Folds of the cross-validation, at least 2 (default: one per patch, which leaves out one patch "
             "at a time)",
             "N");
}

void add_compare(CLI::App& app, Command& command) {
  const Subcommand<CompareOptions> sub(
      app, "compare", "Compare an image with a reference or with the colour chart in its scene", command,
      compare);
  add_value(*sub.app, "image", sub->image, "Image to evaluate", "FILE.exr")->required();
  add_value(*sub.app, "reference", sub->reference,
            "Reference image; optional with --chart (default: the chart's own spectra)", "FILE.exr");
  add_value(*sub.app, "--chart", sub->chart,
            "Scene with a colour chart, which is also compared patch by patch", "SCENE");
  add_parsed(*sub.app, "--delta-e", sub->formula, one_of<DeltaE>({"2000", "94", "76", "cam16", "itp"}),
             "Colour difference formula: CIEDE2000, CIE94, CIE 1976, CAM16-UCS or ITP (default 2000)",
             "2000|94|76|cam16|itp");
  add_value(*sub.app, "--white", sub->white,
            "White of both images, as output/white of a scene (default: the white that they record)",
            "NAME|[X,Y]");
  add_value(*sub.app, "--maps", sub->maps, "Folder for maps of the differences and their histograms (.png)",
            "FOLDER");
  add_max_memory(*sub.app, sub.options);
  add_json(*sub.app, sub->json);
}

// Rejects combinations of options of `calibrate` in which one would have no effect.
void exclude_ineffective_options(CLI::App& calibrate) {
  const auto option = [&calibrate](const std::string& name) { return calibrate.get_option(name); };
  CLI::Option* const measured = option("--measured");
  CLI::Option* const series = option("--series");
  // Only a simulated camera has a chosen response.
  for (const char* simulated : {"--response", "--bits"})
    option(simulated)->excludes(measured)->excludes(series)->excludes("--all-cameras");
  option("--test")->excludes("--all-cameras");
  option("--test-measured")->needs(measured)->needs("--test");
  std::vector<CLI::Option*> color_options;
  for (const char* name :
       {"--training", "--correction", "--objective", "--adaptation", "--folds", "--transfer", "--mtf"})
    color_options.push_back(option(name)->excludes("--all-cameras"));
  option("--output")->excludes("--all-cameras");
  for (const char* name : {"--illuminant", "--chart"}) color_options.push_back(option(name));
  // A series without values of a chart gives responses only, no colours.
  CLI::Option* const test = option("--test");
  CLI::Option* const test_measured = option("--test-measured");
  color_options.push_back(test);
  calibrate.parse_complete_callback([series, measured, color_options, test, test_measured] {
    if (measured->count() > 0 && test->count() > test_measured->count())
      throw CLI::RequiresError(test->get_name(), test_measured->get_name());
    if (series->count() == 0 || measured->count() > 0) return;
    for (const CLI::Option* color_option : color_options)
      if (color_option->count() > 0) throw CLI::RequiresError(color_option->get_name(), measured->get_name());
  });
}

void add_calibrate(CLI::App& app, Command& command) {
  const Subcommand<CalibrateOptions> calibration(app, "calibrate", "Calibrate a camera with a colour chart",
                                                 command, calibrate);
  CLI::App& options = *calibration.app;
  add_value(options, "--camera", calibration->camera,
            "Camera to simulate: a name, FILE.csv, FILE.json, box:LOW-HIGH,LOW-HIGH,LOW-HIGH in "
            "nm, observer:1931 or observer:1964",
            "CAMERA");
  add_response(options, "--camera-response", calibration->camera_response)->needs("--camera");
  add_value(options, "--measured", calibration->measured,
            "Values that a real camera gave for the chart: linear ones, or code values that --series "
            "linearises",
            "FILE.csv");
  add_value(options, "--series", calibration->series,
            "List of photographs and their exposure times, from which the response is recovered",
            "FILE.json");
  options.add_flag("--all-cameras", calibration->all_cameras,
                   "Report how well each shipped camera can be calibrated");
  add_value(options, "--illuminant", calibration->illuminants,
            "Illuminant of the chart; several only with --camera", "ILLUMINANT[,...]")
      ->capture_default_str();
  add_value(options, "--chart", calibration->chart,
            "Table of the reflectances of the patches, or of their measured colours", "TABLE")
      ->capture_default_str();
  add_value(options, "--test", calibration->test,
            "Reflectances of another chart, on which the correction is tested; with --measured also a table "
            "of colours, and --test-measured is needed",
            "TABLE");
  add_value(options, "--test-measured", calibration->test_measured,
            "Values that the camera gave for the chart of --test, in the same light at the same exposure",
            "FILE.csv");
  add_value(options, "--training", calibration->training,
            "Reflectances to which the correction is fitted instead of the chart, with raw values from "
            "the camera's spectral responses",
            "TABLE[,TABLE...]");
  add_value(options, "--response", calibration->planted_response,
            "Response of the simulated camera, which the calibration recovers: linear, gamma:G or "
            "s-curve (default: linear and known)",
            "CURVE");
  add_parsed(options, "--bits", calibration->bits, integer_in<int>(0, 16),
             "Bits of the code values, 0 to 16; 0 for no rounding (default 12)", "N");
  add_characterisation(options, calibration->how);
  add_value(options, "-o,--output", calibration->output,
            "Folder for the OpenColorIO configuration, CLF, ACES input transform and report", "FOLDER");
  add_value(options, "--transfer", calibration->transfer,
            "Answer of transfer --json, shown on the page of the report", "FILE.json");
  add_value(options, "--mtf", calibration->mtf, "Answer of mtf --json, shown on the page of the report",
            "FILE.json");
  exclude_ineffective_options(options);
  add_max_memory(options, calibration.options);
  add_json(options, calibration->json);
}

std::string help_text(const CLI::App& app, const std::string& topic, const std::string& key) {
  if (topic == "scene") return schema::help(schema::fields_of<spec::Scene>(), key);
  if (topic == "slurm") return slurm_help(key);
  if (topic.empty()) return help_of(app, "abbe");
  const CLI::App& command = find_command(app, topic);
  if (key.empty()) return help_of(command, "abbe " + topic);
  if (command.get_subcommands({}).empty())
    throw Error(ErrorCode::usage, key, fmt::format("{} has no commands of its own", topic));
  return help_of(find_command(command, key), fmt::format("abbe {} {}", topic, key));
}

// Adds `abbe help [COMMAND [COMMAND]]`, `abbe help scene [KEY]` and `abbe help slurm [FILE]`.
void add_help(CLI::App& app, Command& command) {
  struct Options {
    std::string command;
    std::string key;
    std::optional<ReferenceFormat> format;
  };
  CLI::App* help =
      app.add_subcommand("help", "Show the help of Abbe, of one command, or of a key of scene files");
  auto options = std::make_shared<Options>();
  add_value(*help, "command", options->command,
            "Command, or scene for the keys of scene files, or slurm for the jobs of a render in parts",
            "COMMAND|scene|slurm");
  add_value(*help, "key", options->key,
            "With scene: a key at any level, or a path of keys such as sensor/readout; with slurm: "
            "the one file to print; with query: one of its commands",
            "KEY");
  add_parsed(*help, "--format", options->format, one_of<ReferenceFormat>({"markdown", "man", "bash"}),
             "Print the reference of all commands in this format", "markdown|man|bash")
      ->excludes("command");
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
  app.set_version_flag("--version", version_text, "Show the versions of Abbe, its data and its libraries");
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
  reject_empty_values(app);
}

void check_names(const CLI::App& app, const std::vector<std::string>& arguments) {
  const CLI::App* at = &app;
  for (const std::string& argument : arguments) {
    if (argument == "--") return;
    if (argument.starts_with("--"))
      check_option(*at, argument);
    else if (!argument.starts_with('-') && !at->get_subcommands({}).empty())
      at = &find_command(*at, argument);
  }
}

}  // namespace abbe::cli
