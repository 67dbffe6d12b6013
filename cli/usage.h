#pragma once

#include <string>
#include <vector>

#include "cli/reference.h"

namespace CLI {
class App;
}  // namespace CLI

namespace abbe::cli {

/// Queries of the command line's description in CLI11.

/// The subcommand of that name. Throws Error{usage} that suggests the nearest name, which CLI11 does not.
[[nodiscard]] const CLI::App& find_command(const CLI::App& app, const std::string& name);

/// Throws Error{usage} with the nearest name for unknown commands and long options among the arguments, which
/// are in the order of the command line without the program. Also rejects `--option=` without a value, for
/// which CLI11 would take the next argument. Arguments after `--` are not checked.
void check_names(const CLI::App& app, const std::vector<std::string>& arguments);

/// Makes every option and argument with a value reject an empty one, including those of subcommands. Empty
/// values come from unset variables of scripts and would count as absent options.
void reject_empty_values(CLI::App& app);

/// Help text of one command, which is called `name` in it.
[[nodiscard]] std::string help_of(const CLI::App& app, const std::string& name);

/// All options and arguments of a command, including its subcommands, whose names begin with `name`.
[[nodiscard]] CommandUsage usage_of(const CLI::App& app, const std::string& name);

}  // namespace abbe::cli
