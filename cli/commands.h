#pragma once

#include <functional>

namespace CLI {
class App;
}  // namespace CLI

namespace abbe::cli {

/// What the parsed command line asks to be run; gives the exit code.
using Command = std::function<int()>;

/// Describes every command and its options to `app`, whose parsing then sets `command`. Both outlive it.
void add_commands(CLI::App& app, Command& command);

}  // namespace abbe::cli
