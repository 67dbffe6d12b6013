#pragma once

#include <filesystem>
#include <string>

#include "io/inputs.h"
#include "validation/statistics/image_difference.h"

namespace abbe::cli {

/// What `abbe compare` was asked for.
struct CompareOptions {
  std::filesystem::path image;
  std::filesystem::path reference;   ///< Empty: the chart's own spectra.
  DeltaE formula = DeltaE::cie2000;  ///< Of patches and maps, and of further figures unless it is this one.
  std::filesystem::path chart{};     ///< Scene whose chart is read out; empty: none.
  std::filesystem::path maps{};      ///< Folder for pictures of the differences; empty: none.
  std::size_t max_memory_bytes = default_memory_limit();
  std::string white{};  ///< Of both images, as `asked_white` takes it; empty: what they tell.
  bool json = false;
};

/// Compares two EXR files, or one with the chart in it, and prints the figures. Returns the exit code. Throws
/// Error{usage} when there is nothing to compare with.
int compare(const CompareOptions& options);

}  // namespace abbe::cli
