#pragma once

#include <string>
#include <vector>

#include "cli/reference.h"

namespace CLI {
class App;
}  // namespace CLI

namespace abbe::cli {

/// What a command line may say, asked of CLI11's description of it.

/// The command of that name. Throws Error{usage} with the nearest name, which CLI11 does not know.
[[nodiscard]] const CLI::App& find_command(const CLI::App& app, const std::string& name);

/// Throws the same for any command or long option among the arguments that does not exist, and for
/// `--option=` that nothing follows, for which CLI11 would take the next argument.
void check_names(const CLI::App& app, const std::vector<std::string>& arguments);

/// Makes every option and argument that takes a value refuse an empty one, those of subcommands included: it
/// comes from an unset variable of a script, and would be taken for an option that is not given.
void refuse_empty_values(CLI::App& app);

/// Help on one command, which is called `name` in it.
[[nodiscard]] std::string help_of(const CLI::App& app, const std::string& name);

/// All that a command allows, its subcommands included.
[[nodiscard]] CommandUsage usage_of(const CLI::App& app, const std::string& name);

}  // namespace abbe::cli
