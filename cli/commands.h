#pragma once

#include <functional>

namespace CLI {
class App;
}  // namespace CLI

namespace abbe::cli {

/// A chosen command with its options; returns the exit code of the program.
using Command = std::function<int()>;

/// Adds all commands with their options to `app`, whose parsing sets `command` to the chosen one. Both must
/// outlive the parsing and the call of the command.
void add_commands(CLI::App& app, Command& command);

}  // namespace abbe::cli
