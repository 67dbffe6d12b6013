#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace abbe::cli {

/// All files that `abbe calibrate` may write to its folder for these illuminants, which are separated by
/// commas.
[[nodiscard]] std::vector<std::filesystem::path> calibration_files(const std::filesystem::path& folder,
                                                                   const std::string& illuminants);

/// Files of an earlier `abbe calibrate` in the folder, from its report and the names in it.
[[nodiscard]] std::vector<std::filesystem::path> earlier_files(const std::filesystem::path& folder);

/// Removes the earlier files that are not among the written ones, since they may belong to another camera.
/// Throws Error{output}.
void remove_unless_written(std::span<const std::filesystem::path> earlier,
                           std::span<const std::filesystem::path> written);

}  // namespace abbe::cli
