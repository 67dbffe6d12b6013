#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "validation/cases/case.h"

namespace abbe::cli {

/// What `abbe validate` was asked for.
struct ValidateOptions {
  std::vector<Suite> suites;  ///< Empty: all.
  bool quick = false;
  std::filesystem::path output;  ///< Folder for `report.html` and `report.json`; empty: neither.
  int threads = 0;               ///< 0: one per processor.
  bool json = false;
};

/// The suites of a list of names as "optics,colour". Throws Error{usage} naming `option` for another name.
[[nodiscard]] std::vector<Suite> parse_suites(const std::string& option, const std::string& text);

/// Recomputes the cases with known answers and prints what came out. Returns 0, or 1 when a case failed.
int validate(const ValidateOptions& options);

}  // namespace abbe::cli
