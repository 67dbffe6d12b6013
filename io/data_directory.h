#pragma once

#include <filesystem>

namespace abbe {

/// The folder of the shipped tables: `$ABBE_DATA`, else `share/abbe/data` beside the running program's
/// folder, else `data` of the source tree it was built from. Throws Error{input} when `$ABBE_DATA` is set to
/// something that is no folder, or none of the others exists.
[[nodiscard]] const std::filesystem::path& data_directory();

}  // namespace abbe
