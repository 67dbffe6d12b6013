#pragma once

#include <string>
#include <vector>

namespace abbe::cli {

/// One option of a command, or an argument that goes by its place.
struct OptionUsage {
  std::vector<std::string> names;  ///< As typed ("-o", "--output"); none for an argument.
  std::string value;               ///< What stands for its value ("N", "auto|path|light"); empty for a flag.
  std::string help;
  bool required = false;
};

/// One command with all that it allows.
struct CommandUsage {
  std::string name;  ///< As typed, "abbe query ior".
  std::string help;
  std::vector<OptionUsage> options;
  std::vector<CommandUsage> commands;
};

/// How the reference of all commands is written.
enum class ReferenceFormat { markdown, man, bash };

/// The reference of a program: a page in Markdown, a manual page in troff's man macros, or a script that
/// completes its command lines under bash.
[[nodiscard]] std::string reference(const CommandUsage& program, ReferenceFormat format);

/// The bash script of `reference`. What a value completes to follows from what stands for it: `a|b` to its
/// words, SCENE, FILE.ext and FILE.ext|FILE.ext to files (a last ... for any number), FOLDER to folders,
/// COMMAND to the commands, KEY to the keys of scene files, KIND to the kinds of `query --list`, and a kind
/// in capitals (MATERIAL) to the names of that kind.
[[nodiscard]] std::string bash_completion(const CommandUsage& program);

}  // namespace abbe::cli
