#include "cli/slurm_help.h"

#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "io/diagnostics.h"
#include "io/error.h"
#include "slurm_files.h"

namespace abbe::cli {

std::string slurm_help(const std::string& name) {
  std::string all =
      "Jobs for a render in parts on a Slurm cluster (docs/distributed.md). `abbe help slurm FILE >FILE` "
      "writes one of them.\n";
  std::vector<std::string> names;
  for (const auto& [file, text] : kSlurmFiles) {
    if (name == file) return std::string(text);
    names.emplace_back(file);
    all += fmt::format("\n{}:\n{}", file, text);
  }
  if (!name.empty()) throw Error(ErrorCode::usage, "", unknown_name("file", name, names));
  return all;
}

}  // namespace abbe::cli
