#pragma once

#include <filesystem>

namespace abbe {

/// Keeps other processes from writing the same output while it lives. The lock is a hidden file beside `path`
/// that the system lets go when its holder ends, however it ends; what a killed holder left half written is
/// removed.
class FileLock {
 public:
  /// Throws Error{output} when another process holds the lock or the folder cannot be written.
  explicit FileLock(const std::filesystem::path& path);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  std::filesystem::path lock_;
  int descriptor_;
};

}  // namespace abbe
