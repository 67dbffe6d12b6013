#pragma once

#include <filesystem>

namespace abbe {

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
