#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace abbe {

/// A memory size for messages: "512 B", "1.0 kB", "84.3 MB", in powers of 1000.
[[nodiscard]] std::string bytes_text(std::size_t bytes);

/// Default memory limit of a command [bytes]: 80 % of the smallest of the machine's memory, the limit of the
/// process's control group and its address-space limit.
[[nodiscard]] std::size_t default_memory_limit();

/// Accounts for the files that a command reads and for the memory of files and films, which is reserved
/// before it is allocated. Memory of libraries, the edge table of a mesh, Embree's acceleration structures
/// and pilot films are not included. Not thread-safe.
class Inputs {
 public:
  explicit Inputs(std::size_t memory_limit_bytes = default_memory_limit()) : limit_(memory_limit_bytes) {}

  void add_file(std::filesystem::path file) { files_.push_back(std::move(file)); }
  /// Every file read so far; a file may occur more than once.
  [[nodiscard]] const std::vector<std::filesystem::path>& files() const { return files_; }

  /// Adds memory [bytes] that `what` (a file, the film) is about to allocate. Throws Error{resource}, which
  /// names `what`, if it exceeds the rest of the limit; nothing is reserved then.
  void reserve_memory(const std::string& what, std::size_t bytes);
  /// Subtracts memory [bytes] that was reserved, at most as much as is reserved.
  void release_memory(std::size_t bytes) { reserved_ -= bytes; }

 private:
  std::size_t limit_;
  std::size_t reserved_ = 0;
  std::vector<std::filesystem::path> files_;
};

/// Owns reserved memory and releases it when destroyed. Its `Inputs` must outlive it.
class MemoryReservation {
 public:
  /// Takes over `bytes` that the caller has reserved in `inputs`, which may be nullptr: nothing is counted
  /// then.
  MemoryReservation(Inputs* inputs, std::size_t bytes) : inputs_(inputs), bytes_(bytes) {}
  MemoryReservation(MemoryReservation&& other) noexcept
      : inputs_(std::exchange(other.inputs_, nullptr)), bytes_(other.bytes_) {}
  MemoryReservation(const MemoryReservation&) = delete;
  MemoryReservation& operator=(const MemoryReservation&) = delete;
  MemoryReservation& operator=(MemoryReservation&&) = delete;
  /// Reserves more memory [bytes] for `what`. Throws like `Inputs::reserve_memory`.
  void reserve(const std::string& what, std::size_t bytes) {
    if (inputs_ == nullptr) return;
    inputs_->reserve_memory(what, bytes);
    bytes_ += bytes;
  }
  ~MemoryReservation() {
    if (inputs_ != nullptr) inputs_->release_memory(bytes_);
  }

 private:
  Inputs* inputs_;
  std::size_t bytes_;
};

}  // namespace abbe
