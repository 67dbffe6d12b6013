#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace abbe::cli {

/// Every file that `abbe calibrate` may write into its folder for these illuminants, which commas separate.
[[nodiscard]] std::vector<std::filesystem::path> calibration_files(const std::filesystem::path& folder,
                                                                   const std::string& illuminants);

/// Removes the files of the folder with the names that `abbe calibrate` gives, for whatever illuminant, which
/// are not among those written: an earlier calibration left them, perhaps of another camera. Throws
/// Error{output}.
void remove_earlier_files(const std::filesystem::path& folder,
                          std::span<const std::filesystem::path> written);

}  // namespace abbe::cli
