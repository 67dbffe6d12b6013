#pragma once

#include <string>
#include <vector>

namespace abbe::cli {

/// One option or positional argument of a command.
struct OptionUsage {
  std::vector<std::string> names;  ///< Names as typed ("-o", "--output"); empty for an argument.
  std::string value;               ///< Placeholder of the value ("N", "auto|path|light"); empty for a flag.
  std::string help;                ///< One sentence without a full stop.
  bool required = false;           ///< True if the command fails without it.
};

/// One command with all its options and arguments.
struct CommandUsage {
  std::string name;  ///< Name as typed, such as "abbe query ior".
  std::string help;  ///< One sentence without a full stop.
  std::vector<OptionUsage> options;
  std::vector<CommandUsage> commands;  ///< Its subcommands.
};

/// Output format of the reference of all commands.
enum class ReferenceFormat { markdown, man, bash };

/// Reference of a program and all its subcommands: a page in Markdown, a manual page in troff's man macros,
/// or a completion script for bash. In the script, the placeholder of a value determines its completions:
/// - `a|b`: these words;
/// - SCENE, FILE.ext and FILE.ext|FILE.ext: files, any number of them if followed by ...;
/// - FOLDER: folders;
/// - COMMAND: the commands;
/// - KEY: the keys of scene files;
/// - KIND: the kinds of `query --list`;
/// - a kind in capitals (MATERIAL): the names of that kind.
[[nodiscard]] std::string reference(const CommandUsage& program, ReferenceFormat format);

/// Text of `abbe help slurm`: all documented jobs for Slurm under their names if `name` is empty, otherwise
/// the exact bytes of the named job. Throws Error{usage} for an unknown name.
[[nodiscard]] std::string slurm_help(const std::string& name);

/// Text of `abbe --version`. Throws Error{input} if there are no tables.
[[nodiscard]] std::string version_text();

}  // namespace abbe::cli
