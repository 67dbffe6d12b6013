#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/inputs.h"
#include "spectral/colorimetry.h"

namespace abbe::cli {

/// Options of `abbe lab`, which its help explains.
struct LabOptions {
  std::string material;
  std::vector<double> at_nm{450, 550, 650};
  std::vector<double> angles_deg{0, 15, 30, 45, 60, 75, 85};  ///< In [0, 90).
  bool inside = false;
  std::string illuminant = "D65";
  Observer observer = Observer::cie1931;
  int samples = 1 << 13;
  std::filesystem::path plot{};
  std::filesystem::path map{};
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;
};

/// Measures a material on the BSDF bench; prints the results, and writes `plot` and `map`. Throws
/// InvalidInput for an invalid material or illuminant. Throws Error{scene} if the formulas of a transparent
/// material do not hold at a wavelength of `at_nm`. Throws Error{usage} if `plot` does not end in .svg, or if
/// an output is the same file as an input or the other output. Throws Error{output} for outputs that cannot
/// be written, and for a `map` of unknown format.
void lab(const LabOptions& options);

}  // namespace abbe::cli
