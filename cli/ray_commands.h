#pragma once

#include "cli/command_options.h"

namespace abbe::cli {

/// Adds `abbe trace`.
void add_trace(CLI::App& app, Command& command);
/// Adds `abbe draw`.
void add_draw(CLI::App& app, Command& command);
/// Adds `abbe lens`.
void add_lens(CLI::App& app, Command& command);

}  // namespace abbe::cli
