#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "io/inputs.h"

namespace abbe {

/// Decompresses a file [RFC1952] into `bytes`; `memory` counts them as they are unpacked. Returns a fault, or
/// nothing on success. More than `limit` bytes are a fault, because a small file may unpack to any length.
[[nodiscard]] std::optional<std::string> read_gzip_bytes(const std::filesystem::path& path, std::size_t limit,
                                                         std::string& bytes, MemoryReservation& memory);

}  // namespace abbe
