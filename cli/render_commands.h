#pragma once

#include "cli/command_options.h"

namespace abbe::cli {

/// Adds `abbe render`.
void add_render(CLI::App& app, Command& command);
/// Adds `abbe meter`.
void add_meter(CLI::App& app, Command& command);

}  // namespace abbe::cli
