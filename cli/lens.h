#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace abbe::cli {

/// What `abbe lens` was asked for.
struct LensOptions {
  std::string lens;                    ///< A file, or the name of one of `data/lens`.
  std::vector<double> wavelengths_nm;  ///< In place of the file's; none to keep these.
  std::vector<double> frequencies_per_mm{10, 20, 40};
  std::filesystem::path html;     ///< A page, or empty.
  std::filesystem::path drawing;  ///< An SVG of the lens, or empty.
  bool json = false;
};

/// Prints what a lens does, and writes its page and drawing. Returns the exit code.
int lens(const LensOptions& options);

}  // namespace abbe::cli
