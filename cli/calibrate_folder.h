#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace abbe::cli {

/// All files that `abbe calibrate` may write to `folder` for these illuminants, which are separated by
/// commas. It writes only some of them, and they need not exist.
[[nodiscard]] std::vector<std::filesystem::path> calibration_files(const std::filesystem::path& folder,
                                                                   const std::string& illuminants);

/// Files in the folder that an earlier `abbe calibrate` wrote, as `folder` / name. They have the name of one
/// of its outputs; names with an illuminant count only if its `report.json` contains that illuminant. Empty
/// if that report cannot be read. Call it before the report is replaced.
[[nodiscard]] std::vector<std::filesystem::path> earlier_files(const std::filesystem::path& folder);

/// Deletes the `earlier` files that are not among the `written` ones, since they may belong to another
/// camera. Paths are compared as text, so both lists must begin with the same folder. Throws Error{output} if
/// a file cannot be deleted.
void remove_unless_written(std::span<const std::filesystem::path> earlier,
                           std::span<const std::filesystem::path> written);

}  // namespace abbe::cli
