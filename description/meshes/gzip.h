#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "io/inputs.h"

namespace abbe {

/// Decompresses the file `path` [RFC1952] and appends the result to `bytes`. Returns nothing on success, and
/// otherwise an error message without the path:
/// - a file that cannot be opened, is not in gzip format, is damaged or is truncated;
/// - `bytes` longer than `limit` bytes in all, because a small file may unpack to any length.
/// `bytes` then holds what was unpacked so far. Its growth is reserved in `memory` before it is allocated.
/// Throws Error{resource} if that exceeds the memory limit.
[[nodiscard]] std::optional<std::string> read_gzip_bytes(const std::filesystem::path& path, std::size_t limit,
                                                         std::string& bytes, MemoryReservation& memory);

}  // namespace abbe
