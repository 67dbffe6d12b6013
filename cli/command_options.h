#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "description/render.h"
#include "sensor/response/channel.h"

namespace abbe::cli {

/// Upper limit of options that accept every finite number.
inline constexpr double kAnyNumber = std::numeric_limits<double>::max();

/// A subcommand and its options, which outlive the parsing.
template <typename Options>
struct Subcommand {
  CLI::App* app;
  std::shared_ptr<Options> options = std::make_shared<Options>();

  /// Adds the subcommand `name` to `parent`. If the command line selects it, parsing sets `command` to `run`
  /// with the parsed options, which returns the exit code or nothing for 0. `command` must outlive the
  /// parsing.
  template <typename Result>
  Subcommand(CLI::App& parent, const std::string& name, const std::string& help, Command& command,
             Result (*run)(const Options&))
      : app(parent.add_subcommand(name, help)) {
    app->callback([&command, run, owned = options] {
      command = [run, owned] {
        if constexpr (std::is_same_v<Result, int>) return run(*owned);
        run(*owned);
        return 0;
      };
    });
  }
  Options* operator->() const { return options.get(); }
};

/// Adds an option or argument. `type` is the placeholder of its value in the help. Returns the option, which
/// `app` owns.
template <typename T>
CLI::Option* add_value(CLI::App& app, const std::string& flag, T& value, const std::string& help,
                       const std::string& type) {
  return app.add_option(flag, value, help)->type_name(type);
}

/// Adds an option or argument whose text `parse` converts to a value, as `parse(flag, text)`. `value` must
/// outlive the parsing.
template <typename T, typename Parse>
CLI::Option* add_parsed(CLI::App& app, const std::string& flag, T& value, Parse parse,
                        const std::string& help, const std::string& type) {
  return app
      .add_option_function<std::string>(
          flag, [&value, parse, flag](const std::string& text) { value = parse(flag, text); }, help)
      ->type_name(type);
}

/// Parser for `add_parsed` of a list of numbers in [low, high] (`parse_numbers`).
inline auto numbers_in(double low, double high) {
  return [low, high](const std::string& option, const std::string& text) {
    return parse_numbers(option, text, low, high);
  };
}

/// Parser of a single number in [low, high]; throws Error{usage} for another text.
inline auto number_in(double low, double high) {
  return [low, high](const std::string& option, const std::string& text) {
    const std::vector<double> numbers = parse_numbers(option, text, low, high);
    if (numbers.size() != 1)
      throw Error(ErrorCode::usage, option, "got \"" + text + "\", allowed one number");
    return numbers.front();
  };
}

/// Parser of an integer in [low, high], which T must be able to hold (`parse_integer`).
template <typename T>
auto integer_in(std::int64_t low, std::int64_t high) {
  return [low, high](const std::string& option, const std::string& text) {
    return static_cast<T>(parse_integer(option, text, low, high));
  };
}

/// Parser for one of some names; the enumerator is the index of the name.
template <typename T>
auto one_of(std::vector<std::string> names) {
  return [names = std::move(names)](const std::string& option, const std::string& text) {
    return static_cast<T>(parse_choice(option, text, names));
  };
}

/// Adds the option for the quantity that a camera's spectral responses multiply, energy or photons.
inline CLI::Option* add_response(CLI::App& app, const std::string& flag, std::optional<ResponseKind>& value) {
  return add_parsed(app, flag, value, one_of<ResponseKind>({"energy", "quantum"}),
                    "Quantity that the camera's spectral responses multiply: energy, or photons for quantum "
                    "(default: quantum for columns named QE, otherwise energy)",
                    "energy|quantum");
}

/// Three numbers separated by commas, as `parse_triple`.
inline Imath::V3d parse_vector(const std::string& option, const std::string& text) {
  const std::array<double, 3> v = parse_triple(option, text);
  return {v[0], v[1], v[2]};
}

/// Adds the argument for the scene file.
inline void add_scene(CLI::App& app, std::filesystem::path& scene) {
  add_value(app, "scene", scene, "Scene file, or - for standard input", "SCENE")->required();
}

/// Adds the flag `--json`.
inline void add_json(CLI::App& app, bool& json) {
  app.add_flag("--json", json, "Print the answer as one JSON object");
}

/// Adds `--max-memory` for commands that read scenes, films or photographs.
template <typename Options>
void add_max_memory(CLI::App& app, const std::shared_ptr<Options>& options) {
  add_parsed(app, "--max-memory", options->max_memory_bytes, parse_bytes,
             "Maximum memory of scenes, images, meshes and films in bytes, or with k, M or G such as 4G "
             "(default: 80 % of the machine's memory)",
             "SIZE");
}

/// Adds `--set`, which may be repeated.
template <typename Options>
void add_overrides(CLI::App& app, const std::shared_ptr<Options>& options,
                   const std::string& help =
                       "Replace a value of the scene file, such as /render/samples=64; may be repeated") {
  app.add_option_function<std::vector<std::string>>(
         "--set",
         [options](const std::vector<std::string>& texts) {
           for (const std::string& text : texts) options->overrides.push_back(parse_override("--set", text));
         },
         help)
      ->allow_extra_args(false)
      ->type_name("/POINTER=VALUE");
}

/// Adds --spp with the help `spp_help`, and --error and --time, which end the render instead. `error_name`
/// names the error, `time_scope` the object of the time.
void add_samples(CLI::App& app, SamplingOptions& settings, const std::string& spp_help,
                 const std::string& error_name, const std::string& time_scope);
/// Adds the options for the integrator, the seed and the threads.
void add_integrator(CLI::App& app, SamplingOptions& settings);

// The commands that are defined outside `commands.cpp`, in the order of the help.
void add_render(CLI::App& app, Command& command);
void add_meter(CLI::App& app, Command& command);
void add_merge(CLI::App& app, Command& command);
void add_convert(CLI::App& app, Command& command);
void add_info(CLI::App& app, Command& command);
void add_trace(CLI::App& app, Command& command);
void add_draw(CLI::App& app, Command& command);
void add_lens(CLI::App& app, Command& command);
void add_query(CLI::App& app, Command& command);
void add_lab(CLI::App& app, Command& command);
void add_develop(CLI::App& app, Command& command);
void add_measure(CLI::App& app, Command& command);
void add_transfer(CLI::App& app, Command& command);
void add_mtf(CLI::App& app, Command& command);
void add_validate(CLI::App& app, Command& command);
void add_bench(CLI::App& app, Command& command);

}  // namespace abbe::cli
