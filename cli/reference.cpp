#include "cli/reference.h"

#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace abbe::cli {
namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 11> kExitCodes{{
    {"0", "success"},
    {"1",
     "validate found a failed case, bench --soak a fault, or bench --strict a run that is worse than the "
     "baseline"},
    {"2", "the command line is invalid"},
    {"3", "the scene file is invalid, or with --strict would give a wrong image"},
    {"4", "an input file is missing or corrupt"},
    {"5", "an output cannot be written"},
    {"6", "a limit on memory or size would be exceeded"},
    {"70", "an internal error of Abbe, or with --strict a discarded sample"},
    {"129", "the terminal was closed; what was rendered is written"},
    {"130", "interrupted from the keyboard; what was rendered is written"},
    {"143", "terminated by SIGTERM; what was rendered is written"},
}};
constexpr std::string_view kDataHelp =
    "Folder of the tables (glass, illuminants, cameras, ...) to use instead of those installed with the "
    "program";

// Heading of an option, such as "-o, --output FILE.exr", or of an argument, such as "SCENE".
std::string heading(const OptionUsage& option) {
  const std::string names = fmt::format("{}", fmt::join(option.names, ", "));
  return names.empty() || option.value.empty() ? names + option.value : names + ' ' + option.value;
}

std::string explanation(const OptionUsage& option) {
  return option.help + (option.required && !option.names.empty() ? "; required" : "");
}

// Synopsis such as "abbe query ior MATERIAL --at NM[,NM...] [OPTION...]".
std::string synopsis(const CommandUsage& command) {
  std::string line = command.name;
  bool more = false;
  for (const OptionUsage& option : command.options) {
    more = more || !option.required;
    if (option.names.empty())
      line += option.required ? ' ' + option.value : " [" + option.value + ']';
    else if (option.required)
      line += ' ' + option.names.back() + ' ' + option.value;
  }
  if (!command.commands.empty()) line += " COMMAND";
  return line + (more ? " [OPTION...]" : "");
}

// True for --help, which every command has and the reference mentions once.
bool is_help(const OptionUsage& option) {
  return !option.names.empty() && option.names.back() == "--help";
}

std::string replaced(std::string_view text, char what, std::string_view by) {
  std::string result;
  for (const char c : text) {
    if (c == what)
      result += by;
    else
      result += c;
  }
  return result;
}

std::string markdown_row(std::string_view left, std::string_view right) {
  return fmt::format("| `{}` | {} |\n", replaced(left, '|', "\\|"), replaced(right, '|', "\\|"));
}

void add_markdown(const CommandUsage& command, std::string& page) {
  page += fmt::format("\n## {}\n\n{}.\n\n```\n{}\n```\n", command.name, command.help, synopsis(command));
  std::string rows;
  for (const OptionUsage& option : command.options)
    if (!is_help(option)) rows += markdown_row(heading(option), explanation(option));
  if (!rows.empty()) page += "\n| | |\n| --- | --- |\n" + rows;
  for (const CommandUsage& inner : command.commands) add_markdown(inner, page);
}

std::string markdown(const CommandUsage& program) {
  std::string page =
      "# Reference of the command line\n\nWritten by `abbe help --format markdown`. Every command has "
      "`--help`.\n";
  add_markdown(program, page);
  page += "\n## Exit codes\n\n| | |\n| --- | --- |\n";
  for (const auto& [code, meaning] : kExitCodes) page += markdown_row(code, meaning);
  page += "\n## Environment\n\n| | |\n| --- | --- |\n" + markdown_row("ABBE_DATA", kDataHelp);
  return page;
}

// Line of text for troff, which would read a first dot or quote as a request and - as a hyphen.
std::string troff(std::string_view text) {
  const std::string safe = replaced(replaced(text, '\\', "\\e"), '-', "\\-");
  return safe.starts_with('.') || safe.starts_with('\'') ? "\\&" + safe : safe;
}

std::string man_entry(std::string_view left, std::string_view right) {
  return fmt::format(".TP\n\\fB{}\\fR\n{}.\n", troff(left), troff(right));
}

void add_man(const CommandUsage& command, std::string& page) {
  page += fmt::format(".SS \"{}\"\n{}.\n", troff(synopsis(command)), troff(command.help));
  for (const OptionUsage& option : command.options)
    if (!is_help(option)) page += man_entry(heading(option), explanation(option));
  for (const CommandUsage& inner : command.commands) add_man(inner, page);
}

std::string man(const CommandUsage& program) {
  std::string page = fmt::format(
      ".TH ABBE 1 \"\" \"Abbe {}\" \"User Commands\"\n.SH NAME\nabbe \\- spectral renderer\n"
      ".SH SYNOPSIS\n\\fB{}\\fR\n.SH DESCRIPTION\n{}.\nEvery command has \\fB\\-\\-help\\fR.\n.SH COMMANDS\n",
      ABBE_VERSION, troff(synopsis(program)), troff(program.help));
  add_man(program, page);
  page += ".SH EXIT STATUS\n";
  for (const auto& [code, meaning] : kExitCodes) page += man_entry(code, meaning);
  return page + ".SH ENVIRONMENT\n" + man_entry("ABBE_DATA", kDataHelp);
}

}  // namespace

std::string reference(const CommandUsage& program, ReferenceFormat format) {
  switch (format) {
    case ReferenceFormat::markdown:
      return markdown(program);
    case ReferenceFormat::man:
      return man(program);
    case ReferenceFormat::bash:
      return bash_completion(program);
  }
  return {};
}

}  // namespace abbe::cli
