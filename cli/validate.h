#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "validation/cases/case.h"

namespace abbe::cli {

/// Options of `abbe validate`.
struct ValidateOptions {
  std::vector<Suite> suites;     ///< Suites to run; empty for all.
  bool quick = false;            ///< Use wider tolerances for films, which takes less than two minutes.
  std::filesystem::path output;  ///< Folder for `report.html` and `report.json`; empty for neither.
  int threads = 0;               ///< Number of threads; 0 for one per processor.
  bool json = false;             ///< Print the answer as JSON instead of plain text.
};

/// Suites of a list of names such as "optics,colour", in its order. Throws Error{usage} that names `option`
/// for an unknown name.
[[nodiscard]] std::vector<Suite> parse_suites(const std::string& option, const std::string& text);

/// Computes the cases with known answers and prints the results. Returns 0, or 1 if a case failed. Throws
/// Error{output} if the report cannot be written.
int validate(const ValidateOptions& options);

}  // namespace abbe::cli
