#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace abbe::cli {

/// Options of `abbe lens`.
struct LensOptions {
  std::string lens;  ///< A file (.json, .zmx or .dat) or a name in `data/lens`.
  /// Replace those of the lens if not empty; the central one is the primary wavelength.
  std::vector<double> wavelengths_nm;
  /// Spatial frequencies of the modulation transfer function [cycles/mm].
  std::vector<double> frequencies_per_mm{10, 20, 40};
  std::filesystem::path html;     ///< HTML page; empty for none.
  std::filesystem::path drawing;  ///< SVG of the section; empty for none.
  bool json = false;              ///< Print the answer as JSON instead of tables.
};

/// Prints the properties of a lens and writes its page and drawing. Returns 0. Throws InvalidInput for an
/// invalid lens, Error{usage} for outputs of another extension, Error{output} if one cannot be written.
int lens(const LensOptions& options);

}  // namespace abbe::cli
