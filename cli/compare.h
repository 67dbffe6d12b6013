#pragma once

#include <filesystem>

namespace abbe::cli {

/// What `abbe compare` was asked for.
struct CompareOptions {
  std::filesystem::path image;
  std::filesystem::path reference;
  bool json = false;
};

/// Compares two EXR files and prints the figures. Returns the exit code.
int compare(const CompareOptions& options);

}  // namespace abbe::cli
