#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace abbe {

/// The file that a write to `path` replaces: `path` with its symbolic links resolved.
[[nodiscard]] std::filesystem::path destination(const std::filesystem::path& path);

/// Stem for companion files (temporary files, locks) of a file called `name`. It is `name`, or its SHA-256 if
/// a companion's name would exceed the length limit of file systems.
[[nodiscard]] std::string companion_stem(const std::string& name);

/// Creates or replaces `path` as a whole or not at all:
/// - `write` fills a temporary file in the same folder, which is flushed to disk;
/// - `verify` returns true if the temporary file reads back as intended;
/// - the temporary file is renamed to `path`, and the folder is flushed.
/// Throws Error{output} and leaves an older file unchanged if a step fails.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& write,
                      const std::function<bool(const std::filesystem::path& temporary)>& verify);

/// Writes `pieces` one after the other to `path`, atomically. The file appears after it has been read back
/// and compared. Throws Error{output}.
void write_atomically(const std::filesystem::path& path, std::span<const std::string_view> pieces);
void write_atomically(const std::filesystem::path& path, std::string_view bytes);

/// Removes temporary files of `path` whose processes no longer run. The caller holds the lock of `path`
/// (`FileLock`).
void remove_leftovers(const std::filesystem::path& path);

/// Throws Error{output} if `path` cannot be created or replaced: its folder is missing or read-only, or
/// `path` is a folder, a device or read-only. It creates and removes a file in the folder to find out.
void require_writable(const std::filesystem::path& path);

}  // namespace abbe
