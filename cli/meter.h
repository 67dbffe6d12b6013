#pragma once

#include <string>
#include <vector>

#include "cli/sampling_options.h"

namespace abbe::cli {

/// Options of `abbe meter`.
struct MeterOptions : SamplingOptions {
  std::filesystem::path scene;      ///< Scene file; "-" is standard input.
  std::vector<std::string> meters;  ///< Names of meters; empty for all.
  std::filesystem::path spectra;    ///< CSV table of the meters' spectra; empty for none.
  bool json = false;
};

/// Prints the readings of a scene's meters. Returns 0, or 128 plus the number of the signal that stopped it.
/// In that case the readings so far are printed and valid.
int meter(const MeterOptions& options);

}  // namespace abbe::cli
