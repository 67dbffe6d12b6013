#pragma once

#include <string>
#include <vector>

#include "cli/render.h"

namespace abbe::cli {

/// Options of `abbe meter`, which its help explains.
struct MeterOptions : SamplingOptions {
  std::filesystem::path scene;
  std::vector<std::string> meters;
  std::filesystem::path spectra;
  bool json = false;
};

/// Prints the readings of a scene's meters. Returns the exit code of the command:
/// - 0 on success;
/// - 128 plus the number of the signal that stopped it; the readings so far are printed and valid;
/// - ErrorCode::internal if `strict` is set and samples were discarded because they were not finite.
///
/// Throws Error{usage} for unknown meters and for `spectra` without a meter that has a spectrum. Throws
/// InvalidInput for an invalid scene, Error{scene} if `strict` is set and light is missing.
int meter(const MeterOptions& options);

}  // namespace abbe::cli
