#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace abbe {

/// File that a write to `path` replaces: `path` with its symbolic links followed. A relative link starts at
/// its own folder.
/// The file need not exist. A cycle of links returns one of them. Never throws.
[[nodiscard]] std::filesystem::path destination(const std::filesystem::path& path);

/// Creates or replaces the `destination` of `path` as a whole or not at all:
/// - `write` fills a temporary file in the same folder, which is flushed to disk;
/// - `verify` returns true if the temporary file reads back as intended;
/// - the temporary file is renamed, and the folder is flushed.
/// A failure before the renaming leaves an older file unchanged and no temporary file. Throws Error{output}
/// if a step fails, if `verify` returns false, and instead of Error{input} or a foreign exception from the
/// callbacks. Their other Errors pass through.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& write,
                      const std::function<bool(const std::filesystem::path& temporary)>& verify);

/// Writes `pieces` one after the other to `path`, atomically. The file appears after it has been read back
/// and compared. Throws Error{output} as above.
void write_atomically(const std::filesystem::path& path, std::span<const std::string_view> pieces);
void write_atomically(const std::filesystem::path& path, std::string_view bytes);

/// Creates and removes a file next to `path` to find out if `path` can be created or replaced. Throws
/// Error{output} if not:
/// - its folder is missing or read-only;
/// - `path` is a folder, a device, read-only, a cycle of links, too long, or has no file name.
void require_writable(const std::filesystem::path& path);

/// Excludes other `FileLock` objects for the same output, in this process or another, during its lifetime.
/// The lock is a hidden file next to the `destination` of `path`. The destructor removes it; the operating
/// system releases it when the process ends, however it ends. The constructor removes temporary files of
/// `path` whose processes no longer run.
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
