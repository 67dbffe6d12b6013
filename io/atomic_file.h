#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

namespace abbe {

/// Makes `path` appear complete or not at all: `write` fills a temporary file in the same folder, which is
/// flushed to disk, checked by `verify`, renamed to `path`, and its folder flushed. Throws Error{output},
/// leaving any older file as it was.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& write,
                      const std::function<bool(const std::filesystem::path& temporary)>& verify);

/// The same for a text or bytes already in memory, verified by reading them back.
void write_atomically(const std::filesystem::path& path, std::string_view bytes);

/// Throws Error{output} now if a file could not be created at `path` later: folder missing or read-only, or
/// `path` a folder.
void require_writable(const std::filesystem::path& path);

}  // namespace abbe
