#pragma once

#include "cli/command_options.h"

namespace abbe::cli {

/// Adds `abbe query` with all its subcommands.
void add_query(CLI::App& app, Command& command);
/// Adds `abbe lab`.
void add_lab(CLI::App& app, Command& command);

/// Adds `abbe transfer`.
void add_transfer(CLI::App& app, Command& command);
/// Adds `abbe mtf`.
void add_mtf(CLI::App& app, Command& command);

}  // namespace abbe::cli
