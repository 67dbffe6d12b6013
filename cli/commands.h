#pragma once

#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}  // namespace CLI

namespace abbe::cli {

/// A chosen command with its options; returns the exit code of the program.
using Command = std::function<int()>;

/// Adds all commands with their options to `app`, whose parsing sets `command` to the chosen one. Both must
/// outlive the parsing and the call of the command.
void add_commands(CLI::App& app, Command& command);

/// Throws Error{usage} with the nearest name for unknown commands and long options among the arguments, which
/// are in the order of the command line without the program. Also rejects `--option=` without a value, for
/// which CLI11 would take the next argument. Arguments after `--` are not checked.
void check_names(const CLI::App& app, const std::vector<std::string>& arguments);

}  // namespace abbe::cli
