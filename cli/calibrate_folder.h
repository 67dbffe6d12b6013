#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace abbe::cli {

/// Every file that `abbe calibrate` may write into its folder for these illuminants, which commas separate.
[[nodiscard]] std::vector<std::filesystem::path> calibration_files(const std::filesystem::path& folder,
                                                                   const std::string& illuminants);

/// The files of the folder that an earlier `abbe calibrate` left there, by its report and the names it gives.
[[nodiscard]] std::vector<std::filesystem::path> earlier_files(const std::filesystem::path& folder);

/// Removes those that are not among the written ones: they may be of another camera. Throws Error{output}.
void remove_unless_written(std::span<const std::filesystem::path> earlier,
                           std::span<const std::filesystem::path> written);

}  // namespace abbe::cli
