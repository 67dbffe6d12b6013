#pragma once

#include <filesystem>
#include <string>

#include "io/inputs.h"
#include "report/image_difference.h"

namespace abbe::cli {

/// Options of `abbe compare`, which its help explains.
struct CompareOptions {
  std::filesystem::path image;
  std::filesystem::path reference;
  DeltaE formula = DeltaE::cie2000;  ///< Further figures are printed unless it is the default.
  std::filesystem::path chart{};
  std::filesystem::path maps{};
  std::size_t max_memory_bytes = default_memory_limit();
  std::string white{};
  bool json = false;
};

/// Compares two EXR files, or one with the chart in it, and prints the figures. Throws Error{usage} if there
/// is nothing to compare with, and for maps or a white without a reference. Throws Error{input} for files
/// that cannot be read or compared, Error{output} if a map cannot be written.
void compare(const CompareOptions& options);

}  // namespace abbe::cli
