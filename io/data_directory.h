#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace abbe {

/// Folder of the shipped tables, chosen at the first call and then constant. It is the environment variable
/// `ABBE_DATA` if set, else the folder passed to `set_data_directory`. Without both it is
/// `../share/abbe/data`, relative to the folder of the running program with its symbolic links resolved.
/// Throws Error{input} if the chosen folder does not exist; the next call chooses again.
[[nodiscard]] const std::filesystem::path& data_directory();

/// Sets the folder for programs that are not installed next to the data. It has no effect after the first
/// successful call of `data_directory`. Not thread-safe.
void set_data_directory(const std::filesystem::path& folder);

/// Paths of all `.csv` files in `data_directory` and its subfolders except `scenes`, in byte order. Empty if
/// the folder is missing or unreadable; never throws Error.
[[nodiscard]] std::vector<std::filesystem::path> data_tables();

/// SHA-256 of the listing that `sha256sum` prints for all `data_tables`, with relative paths in byte order.
/// Throws Error{input} if the folder is missing or a table cannot be read.
[[nodiscard]] const std::string& data_sha256();

}  // namespace abbe
