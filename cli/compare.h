#pragma once

#include <filesystem>
#include <string>

#include "io/inputs.h"
#include "validation/statistics/image_difference.h"

namespace abbe::cli {

/// Options of `abbe compare`.
struct CompareOptions {
  std::filesystem::path image;
  std::filesystem::path reference;  ///< Reference image; empty for the chart's own spectra.
  /// Formula for patches and maps. Further figures are printed unless it is the default.
  DeltaE formula = DeltaE::cie2000;
  std::filesystem::path chart{};  ///< Scene whose chart is evaluated; empty for none.
  std::filesystem::path maps{};   ///< Folder for pictures of the differences; empty for none.
  std::size_t max_memory_bytes = default_memory_limit();
  std::string white{};  ///< White of both images, as `asked_white` takes it; empty for the recorded ones.
  bool json = false;
};

/// Compares two EXR files, or one with the chart in it, and prints the figures. Returns the exit code. Throws
/// Error{usage} if there is nothing to compare with.
int compare(const CompareOptions& options);

}  // namespace abbe::cli
