#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "cli/query.h"
#include "cli/reference.h"
#include "description/scene.h"
#include "io/schema/documentation.h"
#include "io/text.h"

namespace abbe::cli {
namespace {

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
  return std::all_of(words.begin(), words.end(), [](const std::string& word) {
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
  return std::find(kinds.begin(), kinds.end(), kind) != kinds.end() ? "names " + kind : "none";
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

}  // namespace

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

}  // namespace abbe::cli
