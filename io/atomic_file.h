#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace abbe {

/// The file that writing to `path` replaces: `path`, or where its symbolic links lead.
[[nodiscard]] std::filesystem::path destination(const std::filesystem::path& path);

/// By what a file beside one of this name is called, which has an ending of its own: the name, or its SHA-256
/// where both would be too long for file systems.
[[nodiscard]] std::string companion_stem(const std::string& name);

/// Makes `path` appear complete or not at all: `write` fills a temporary file in the same folder, which is
/// flushed to disk, checked by `verify`, renamed to `path`, and its folder flushed. Throws Error{output},
/// leaving any older file as it was.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& write,
                      const std::function<bool(const std::filesystem::path& temporary)>& verify);

/// Writes text or bytes already in memory to a file, one piece after the other, which appears once reading it
/// back has verified them. Throws Error{output}.
void write_atomically(const std::filesystem::path& path, std::span<const std::string_view> pieces);
void write_atomically(const std::filesystem::path& path, std::string_view bytes);

/// Removes the temporary files of `path` that processes now dead have left. For the holder of its lock.
void remove_leftovers(const std::filesystem::path& path);

/// Throws Error{output} now if a file could not be created at `path` later: folder missing or read-only, or
/// `path` a folder or read-only.
void require_writable(const std::filesystem::path& path);

}  // namespace abbe
