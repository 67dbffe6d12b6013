#pragma once

#include <filesystem>

#include "io/image.h"

namespace abbe {

/// Writes every channel as 32-bit float, ZIP compressed, metadata as string attributes; atomically, and
/// re-read before it appears. Throws Error{output}.
void write_exr(const std::filesystem::path& path, const Image& image);

/// Reads a single-part scan-line or tiled EXR, all channels as float, string attributes as metadata. Throws
/// Error{input} for a missing, truncated or malformed file and Error{resource} for one beyond the limits of
/// `io/image.h`.
[[nodiscard]] Image read_exr(const std::filesystem::path& path);

}  // namespace abbe
