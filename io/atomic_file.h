#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace abbe {

/// File that a write to `path` replaces: `path` with its symbolic links followed. It need not exist. A cycle
/// of links returns one of them. Never throws.
[[nodiscard]] std::filesystem::path destination(const std::filesystem::path& path);

/// Creates or replaces the `destination` of `path` as a whole or not at all: `write` fills a temporary file
/// in the same folder, `verify` returns true if it reads back as intended, and then it is renamed. File and
/// folder are flushed to disk. A failure before the renaming leaves an older file unchanged. Throws
/// Error{output} if a step fails, and instead of Error{input} or a foreign exception from the callbacks.
/// Their other Errors pass through.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& write,
                      const std::function<bool(const std::filesystem::path& temporary)>& verify);

/// Writes `pieces` one after the other to `path`, atomically. The file appears after it has been read back
/// and compared. Throws Error{output} as above.
void write_atomically(const std::filesystem::path& path, std::span<const std::string_view> pieces);
void write_atomically(const std::filesystem::path& path, std::string_view bytes);

/// Finds out if `path` can be created or replaced. Throws Error{output} if its folder is missing or
/// read-only. Throws it too if `path` is a folder, a device, read-only, a cycle of links, too long, or has no
/// file name.
void require_writable(const std::filesystem::path& path);

/// Excludes other `FileLock` objects for the same output, in this process or another, by a hidden file next
/// to the `destination` of `path`. The operating system releases it when the process ends. The constructor
/// removes temporary files of `path` whose processes no longer run.
class FileLock {
 public:
  /// Does not wait: throws Error{output} if another lock exists or the lock file cannot be created.
  explicit FileLock(const std::filesystem::path& path);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  std::filesystem::path lock_;
  int descriptor_;
};

}  // namespace abbe
