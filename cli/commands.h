#pragma once

#include <functional>

namespace CLI {
class App;
}  // namespace CLI

namespace abbe::cli {

/// A chosen command with its options; returns the exit code of the program.
using Command = std::function<int()>;

/// Adds all commands with their options to `app`, whose parsing sets `command`. Both must outlive the
/// parsing.
void add_commands(CLI::App& app, Command& command);

}  // namespace abbe::cli
