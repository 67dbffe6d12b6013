#pragma once

#include <string>
#include <vector>

#include "cli/sampling_options.h"

namespace abbe::cli {

/// What `abbe meter` was asked for.
struct MeterOptions : SamplingOptions {
  std::filesystem::path scene;      ///< "-" is standard input.
  std::vector<std::string> meters;  ///< By name; none for all.
  std::filesystem::path spectra;    ///< A table of the meters' spectra, or empty.
  bool json = false;
};

/// Prints what the meters of a scene read. Returns the exit code: 0, or 128 plus the signal that stopped it
/// early, the readings done printed and valid.
int meter(const MeterOptions& options);

}  // namespace abbe::cli
