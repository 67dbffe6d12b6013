#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace abbe::cli {

/// Options of `abbe lens`.
struct LensOptions {
  std::string lens;                    ///< A file or a name in `data/lens`.
  std::vector<double> wavelengths_nm;  ///< Replace those of the file if not empty.
  std::vector<double> frequencies_per_mm{10, 20, 40};
  std::filesystem::path html;     ///< HTML page; empty for none.
  std::filesystem::path drawing;  ///< SVG of the section; empty for none.
  bool json = false;
};

/// Prints the properties of a lens and writes its page and drawing. Returns the exit code.
int lens(const LensOptions& options);

}  // namespace abbe::cli
