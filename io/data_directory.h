#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace abbe {

/// The folder of the shipped tables: `$ABBE_DATA`, else that of `set_data_directory`, else `share/abbe/data`
/// beside the running program's folder, links to the program followed. A build folder holds a link of that
/// name to the source tree's, so that no path of a source tree is part of a program. Throws Error{input} when
/// there is no such folder.
[[nodiscard]] const std::filesystem::path& data_directory();

/// Names that folder for a program which is not installed beside it. Only a call before the first use of
/// `data_directory` counts.
void set_data_directory(const std::filesystem::path& folder);

/// The tables of `data_directory`: every `.csv` file, its `scenes` left out; none where there is no folder.
[[nodiscard]] std::vector<std::filesystem::path> data_tables();

/// SHA-256 over `data_tables`: of what `sha256sum` prints for them all by their paths within the folder, in
/// the order of the paths' bytes. Worked out when first asked for. Throws Error{input} when a table cannot be
/// read.
[[nodiscard]] const std::string& data_sha256();

}  // namespace abbe
