#pragma once

#include <string>

namespace abbe::cli {

/// What `abbe help slurm` prints: the documented jobs for Slurm, each under its name, or the one of that
/// name, to the byte. Throws Error{usage} for another name.
[[nodiscard]] std::string slurm_help(const std::string& name);

}  // namespace abbe::cli
