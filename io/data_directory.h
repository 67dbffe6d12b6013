#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace abbe {

/// The folder of the shipped tables. The first of these that is set or exists:
/// - the environment variable `ABBE_DATA`;
/// - the folder passed to `set_data_directory`;
/// - `../share/abbe/data`, relative to the folder of the running program with its symbolic links resolved.
/// Build folders contain a link of that name to the source tree's data, so that no program contains a path of
/// the source tree. Throws Error{input} if the folder does not exist.
[[nodiscard]] const std::filesystem::path& data_directory();

/// Sets the folder for programs that are not installed next to the data. It has no effect after the first
/// call of `data_directory`.
void set_data_directory(const std::filesystem::path& folder);

/// Paths of all `.csv` files of `data_directory` except those in `scenes`, sorted. Empty if the folder is
/// missing.
[[nodiscard]] std::vector<std::filesystem::path> data_tables();

/// SHA-256 of the listing that `sha256sum` prints for all `data_tables`, with paths relative to the folder in
/// byte order. Computed at the first call. Throws Error{input} if a table cannot be read.
[[nodiscard]] const std::string& data_sha256();

}  // namespace abbe
