#include "cli/help.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "cli/query.h"
#include "description/scene.h"
#include "io/data_directory.h"
#include "io/diagnostics.h"
#include "io/error.h"
#include "io/schema/documentation.h"
#include "io/text.h"
#include "slurm_files.h"
#include "validation/bench/machine.h"

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
  for (const char c : text) result += c == what ? by : std::string_view(&c, 1);
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

// Finds the command and the position of the word to complete. It reads the line itself, since bash splits
// words at = and :. For the same reason it removes the text up to the last colon from the answers, which bash
// does not replace.
constexpr std::string_view kScript = R"BASH(
_abbe() {
  local line=${COMP_LINE:0:COMP_POINT} path=abbe position=0 kind= commands= options= i
  local -a words
  read -ra words <<<"$line"
  [[ $line == *[[:space:]] ]] && words+=("")
  local last=$((${#words[@]} - 1))
  local word=${words[last]} program=${words[0]/#\~/$HOME}
  _abbe_words "$path"
  for ((i = 1; i < last; i++)); do
    kind=
    case ${words[i]} in
      -*=*) ;;
      -*) if _abbe_kind "$path ${words[i]}"; then ((++i)); fi ;;
      *)
        if [[ " $commands " == *" ${words[i]} "* ]]; then
          path+=" ${words[i]}"
          _abbe_words "$path"
        else
          ((++position))
        fi
        ;;
    esac
  done
  local value=$word
  if ((i == last)); then  # not the value of the option before
    kind=
    if [[ $word == --*=* ]]; then
      _abbe_kind "$path ${word%%=*}"
      value=${word#*=}
    elif [[ $word == -* ]]; then
      kind="words $options"
    elif [[ $commands ]]; then
      kind="words $commands"
    else
      _abbe_kind "$path $((position + 1))" || kind="words $options"
    fi
  fi
  _abbe_answer "$program" "$value" $kind
  local before=${value%"${value##*:}"} j
  if [[ $before && $COMP_WORDBREAKS == *:* ]]; then
    for j in "${!COMPREPLY[@]}"; do COMPREPLY[j]=${COMPREPLY[j]#"$before"}; done
  fi
}

_abbe_answer() {  # PROGRAM VALUE KIND...
  local IFS=$'\n' value=$2 i
  case $3 in
    words) mapfile -t COMPREPLY < <(compgen -W "${*:4}" -- "$value") ;;
    names)
      mapfile -t COMPREPLY < <(compgen -W "$("$1" query --list "$4" 2>/dev/null | cut -f1)" -- "$value")
      if ((${#COMPREPLY[@]})); then
        mapfile -t COMPREPLY < <(printf '%q\n' "${COMPREPLY[@]}")
      else
        _abbe_answer "$1" "$value" files csv yml
      fi
      ;;
    files)
      compopt -o filenames 2>/dev/null
      mapfile -t COMPREPLY < <(
        for i in "${@:4}"; do compgen -f -X "!*.$i" -- "$value"; done
        compgen -d -- "$value"
      )
      ;;
    folders)
      compopt -o filenames 2>/dev/null
      mapfile -t COMPREPLY < <(compgen -d -- "$value")
      ;;
    *) COMPREPLY=() ;;
  esac
}

complete -F _abbe abbe
)BASH";

std::string short_name(const CommandUsage& command) {
  return command.name.substr(command.name.rfind(' ') + 1);
}

std::string without(std::string text, std::string_view characters) {
  std::erase_if(text, [characters](char c) { return characters.find(c) != std::string_view::npos; });
  return text;
}

// True for placeholders of files, such as "FILE.exr|FILE.abbepart".
bool names_files(const std::vector<std::string>& words) {
  return std::ranges::all_of(words, [](const std::string& word) {
    const std::size_t dot = word.find('.');
    return dot != std::string::npos && dot + 1 < word.size() && word[dot + 1] != '.';
  });
}

// Arguments of `_abbe_answer` for the placeholder of a value.
std::string kind_of(const std::string& value, const CommandUsage& program) {
  const std::vector<std::string> kinds = table_kinds();
  std::vector<std::string> words = split(without(value, "[]"), '|');
  if (names_files(words)) {
    for (std::string& word : words) word = without(word.substr(word.find('.') + 1), ".");
    return fmt::format("files {}", fmt::join(words, " "));
  }
  if (std::erase(words, "COMMAND") > 0)
    for (const CommandUsage& command : program.commands) words.push_back(short_name(command));
  if (words.size() > 1) return fmt::format("words {}", fmt::join(words, " "));
  std::string& word = words.front();
  if (word == "SCENE") return "files json";
  if (word == "FOLDER") return "folders";
  if (word == "KIND") return fmt::format("words {}", fmt::join(kinds, " "));
  if (word == "KEY")
    return fmt::format("words {}", fmt::join(schema::all_keys(schema::fields_of<spec::Scene>()), " "));
  const std::string kind = lower_case(word);
  return std::ranges::find(kinds, kind) != kinds.end() ? "names " + kind : "none";
}

// Patterns of `_abbe_kind` for one option: all its names, or the position of an argument. A repeated argument
// matches all positions.
std::string keys_of(const OptionUsage& option, const std::string& command, int& position) {
  std::vector<std::string> keys;
  for (const std::string& name : option.names) keys.push_back(fmt::format("'{} {}'", command, name));
  if (keys.empty() && option.value.ends_with("...")) return fmt::format("'{} '[1-9]*", command);
  if (keys.empty()) keys.push_back(fmt::format("'{} {}'", command, ++position));
  return fmt::format("{}", fmt::join(keys, " | "));
}

// Cases of `_abbe_words` for a command and its subcommands.
void add_words(const CommandUsage& command, std::string& script) {
  std::vector<std::string> commands;
  std::vector<std::string> options;
  for (const CommandUsage& inner : command.commands) commands.push_back(short_name(inner));
  for (const OptionUsage& option : command.options)
    if (!option.names.empty()) options.push_back(option.names.back());
  script += fmt::format("    '{}') commands='{}' options='{}' ;;\n", command.name, fmt::join(commands, " "),
                        fmt::join(options, " "));
  for (const CommandUsage& inner : command.commands) add_words(inner, script);
}

// Cases of `_abbe_kind` for a command and its subcommands.
void add_kinds(const CommandUsage& command, const CommandUsage& program, std::string& script) {
  int position = 0;
  for (const OptionUsage& option : command.options)
    if (!option.value.empty())
      script += fmt::format("    {}) kind='{}' ;;\n", keys_of(option, command.name, position),
                            kind_of(option.value, program));
  for (const CommandUsage& inner : command.commands) add_kinds(inner, program, script);
}

// Versions from the build, since this module does not include the headers of the libraries.
constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kLibraries{{
    {"Embree", ABBE_EMBREE_VERSION},
    {"OpenEXR", ABBE_OPENEXR_VERSION},
    {"OpenImageIO", ABBE_OPENIMAGEIO_VERSION},
    {"OpenColorIO", ABBE_OPENCOLORIO_VERSION},
    {"Ceres", ABBE_CERES_VERSION},
}};

std::string bash_completion(const CommandUsage& program) {
  std::string script =
      "# Completes abbe's command lines under bash. Written by `abbe help --format bash`.\n\n"
      "_abbe_words() {  # COMMAND: sets the commands and options that may follow\n  case $1 in\n";
  add_words(program, script);
  script +=
      "  esac\n}\n\n_abbe_kind() {  # COMMAND OPTION or COMMAND POSITION: sets the kind of its value, if it "
      "has "
      "one\n  case $1 in\n";
  add_kinds(program, program, script);
  script += "    *) return 1 ;;\n  esac\n}\n";
  return script + std::string(kScript);
}

}  // namespace

std::string reference(const CommandUsage& program, ReferenceFormat format) {
  if (format == ReferenceFormat::markdown) return markdown(program);
  return format == ReferenceFormat::man ? man(program) : bash_completion(program);
}

std::string slurm_help(const std::string& name) {
  std::string all =
      "Jobs for a render in parts on a Slurm cluster (docs/guide/machines.md). `abbe help slurm FILE >FILE` "
      "writes one of them.\n";
  std::vector<std::string> names;
  for (const auto& [file, text] : kSlurmFiles) {
    if (name == file) return std::string(text);
    names.emplace_back(file);
    all += fmt::format("\n{}:\n{}", file, text);
  }
  if (!name.empty()) throw Error(ErrorCode::usage, "", unknown_name("file", name, names));
  return all;
}

std::string version_text() {
  std::string lines = fmt::format("abbe {}\ndata {}\ndata_sha256 {}\ncompiler {}\n", ABBE_VERSION,
                                  data_directory().string(), data_sha256(), this_machine().compiler);
  for (const auto& [name, version] : kLibraries) lines += fmt::format("{} {}\n", name, version);
  lines.pop_back();  // CLI11 ends the line
  return lines;
}

}  // namespace abbe::cli
