#include "cli/usage.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "io/diagnostics.h"
#include "io/error.h"

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
  if (std::find(names.begin(), names.end(), name) == names.end())
    throw Error(ErrorCode::usage, "", unknown_name("option", name, names));
}

std::string names_of(const std::set<CLI::Option*>& options) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options)
    names.push_back(option->nonpositional() ? option->get_name() : option->get_type_name());
  std::sort(names.begin(), names.end());  // the set is in the order of addresses
  return fmt::format("{}", fmt::join(names, ", "));
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
      check_option(*at, argument);
    else if (!argument.starts_with('-') && !at->get_subcommands({}).empty())
      at = &find_command(*at, argument);
  }
}

void reject_empty_values(CLI::App& app) {
  for (CLI::Option* option : app.get_options())
    if (option->get_items_expected_min() > 0)
      option->check([option](const std::string& value) { return value.empty() ? no_value(*option) : ""; });
  for (CLI::App* command : app.get_subcommands({})) reject_empty_values(*command);
}

// Not `app.help()`, which would show the help of the subcommand that was given.
std::string help_of(const CLI::App& app, const std::string& name) {
  return app.get_formatter()->make_help(&app, name, CLI::AppFormatMode::Normal);
}

CommandUsage usage_of(const CLI::App& app, const std::string& name) {
  CommandUsage usage{name, app.get_description(), {}, {}};
  for (const CLI::Option* option : app.get_options()) usage.options.push_back(usage_of(*option));
  for (const CLI::App* command : app.get_subcommands({}))
    usage.commands.push_back(usage_of(*command, name + ' ' + command->get_name()));
  return usage;
}

}  // namespace abbe::cli
