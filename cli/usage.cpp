#include "cli/usage.h"

#include <algorithm>

#include <CLI/CLI.hpp>

#include "io/diagnostics.h"
#include "io/error.h"

namespace abbe::cli {
namespace {

void check_option(const CLI::App& app, const std::string& name) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& known : option->get_lnames()) names.push_back("--" + known);
  if (std::find(names.begin(), names.end(), name) == names.end())
    throw Error(ErrorCode::usage, "", unknown_name("option", name, names));
}

}  // namespace

const CLI::App& find_command(const CLI::App& app, const std::string& name) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) {
    if (command->get_name() == name) return *command;
    names.push_back(command->get_name());
  }
  throw Error(ErrorCode::usage, "", unknown_name("command", name, names));
}

void check_names(const CLI::App& app, const std::vector<std::string>& arguments) {
  const CLI::App* at = &app;
  for (const std::string& argument : arguments) {
    if (argument == "--") return;
    if (argument.starts_with("--"))
      check_option(*at, argument.substr(0, argument.find('=')));
    else if (!argument.starts_with('-') && !at->get_subcommands({}).empty())
      at = &find_command(*at, argument);
  }
}

// Not `app.help()`, which would show the help of the subcommand that was given.
std::string help_of(const CLI::App& app, const std::string& name) {
  return app.get_formatter()->make_help(&app, name, CLI::AppFormatMode::Normal);
}

}  // namespace abbe::cli
