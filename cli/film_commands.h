#pragma once

#include "cli/command_options.h"

namespace abbe::cli {

/// Adds `abbe develop`.
void add_develop(CLI::App& app, Command& command);
/// Adds `abbe measure`.
void add_measure(CLI::App& app, Command& command);

}  // namespace abbe::cli
