#pragma once

#include <filesystem>

namespace abbe {

/// Prevents other processes from writing the same output during its lifetime. The lock is a hidden file next
/// to `path`, which the operating system releases when the process ends, however it ends. The constructor
/// removes temporary files of processes that were killed.
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
