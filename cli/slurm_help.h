#pragma once

#include <string>

namespace abbe::cli {

/// Text of `abbe help slurm`: all documented jobs for Slurm under their names if `name` is empty, otherwise
/// the exact bytes of the named job. Throws Error{usage} for an unknown name.
[[nodiscard]] std::string slurm_help(const std::string& name);

}  // namespace abbe::cli
