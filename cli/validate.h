#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "validation/cases/case.h"

namespace abbe::cli {

/// Options of `abbe validate`.
struct ValidateOptions {
  std::vector<Suite> suites;  ///< Suites to run; empty for all.
  bool quick = false;
  std::filesystem::path output;  ///< Folder for `report.html` and `report.json`; empty for neither.
  int threads = 0;               ///< Number of threads; 0 for one per processor.
  bool json = false;
};

/// Suites of a list of names such as "optics,colour". Throws Error{usage} that names `option` for an unknown
/// name.
[[nodiscard]] std::vector<Suite> parse_suites(const std::string& option, const std::string& text);

/// Computes the cases with known answers and prints the results. Returns 0, or 1 if a case failed.
int validate(const ValidateOptions& options);

}  // namespace abbe::cli
