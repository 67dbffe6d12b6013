#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "io/inputs.h"

namespace abbe {

/// The bytes that a file holds packed [RFC1952], which `held` counts as they are unpacked; or why there are
/// none. There are at most `limit`, since a small file may unpack to any length.
[[nodiscard]] std::optional<std::string> read_gzip_bytes(const std::filesystem::path& path, std::size_t limit,
                                                         std::string& bytes, HeldMemory& held);

}  // namespace abbe
