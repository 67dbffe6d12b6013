#pragma once

#include <filesystem>
#include <string>

#include "io/inputs.h"
#include "report/image_difference.h"

namespace abbe::cli {

/// Options of `abbe compare`.
struct CompareOptions {
  std::filesystem::path image;      ///< EXR file to evaluate.
  std::filesystem::path reference;  ///< EXR file to compare with; empty for the chart's own spectra.
  /// Formula for patches and maps. Further figures are printed unless it is the default.
  DeltaE formula = DeltaE::cie2000;
  std::filesystem::path chart{};  ///< Scene whose chart is evaluated; empty for none.
  std::filesystem::path maps{};   ///< Folder for pictures of the differences; empty for none.
  std::size_t max_memory_bytes = default_memory_limit();
  /// White of both images, as `requested_white` takes it; empty for the recorded ones.
  std::string white{};
  bool json = false;  ///< Print the answer as JSON instead of plain text.
};

/// Compares two EXR files, or one with the chart in it, and prints the figures. Returns 0, however large the
/// differences are. Throws Error{usage} if there is nothing to compare with, and for maps or a white without
/// a reference. Throws Error{input} for files that cannot be read or compared, Error{output} if a map cannot
/// be written.
int compare(const CompareOptions& options);

}  // namespace abbe::cli
