#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace abbe {

/// An amount of memory as messages tell it: "512 B", "1.0 kB", "84.3 MB", in powers of 1000.
[[nodiscard]] std::string bytes_text(std::size_t bytes);

/// Memory that a command takes unless told otherwise [bytes]: 80 % of the machine's, or of what the process's
/// control group or address space is limited to, whichever is least.
[[nodiscard]] std::size_t default_memory_limit();

/// What one command reads: its files, and the memory that these and its films take, which is counted before
/// it is asked for. Not counted are what the readers of other libraries hold while they read, the table of a
/// mesh's edges while it is checked, what rays are traced through (Embree's), and the films of pilots.
class Inputs {
 public:
  explicit Inputs(std::size_t memory_limit_bytes = default_memory_limit()) : limit_(memory_limit_bytes) {}

  /// Remembers a file that is read.
  void add_file(std::filesystem::path file) { files_.push_back(std::move(file)); }
  /// Every file read so far, some more than once.
  [[nodiscard]] const std::vector<std::filesystem::path>& files() const { return files_; }

  /// Counts memory that `what`, a file or the film, is about to take. Throws Error{resource} when that is
  /// more than is left.
  void take_memory(const std::string& what, std::size_t bytes);
  /// Counts it no longer.
  void give_back_memory(std::size_t bytes) { taken_ -= bytes; }

 private:
  std::size_t limit_;
  std::size_t taken_ = 0;
  std::vector<std::filesystem::path> files_;
};

/// Gives counted memory back at the end of its life.
class HeldMemory {
 public:
  /// `inputs` may be none.
  HeldMemory(Inputs* inputs, std::size_t bytes) : inputs_(inputs), bytes_(bytes) {}
  HeldMemory(HeldMemory&& other) noexcept
      : inputs_(std::exchange(other.inputs_, nullptr)), bytes_(other.bytes_) {}
  HeldMemory(const HeldMemory&) = delete;
  HeldMemory& operator=(const HeldMemory&) = delete;
  HeldMemory& operator=(HeldMemory&&) = delete;
  /// Counts more for `what`, to be given back with the rest. Throws as `Inputs::take_memory` does.
  void take_more(const std::string& what, std::size_t bytes) {
    if (inputs_ == nullptr) return;
    inputs_->take_memory(what, bytes);
    bytes_ += bytes;
  }
  ~HeldMemory() {
    if (inputs_ != nullptr) inputs_->give_back_memory(bytes_);
  }

 private:
  Inputs* inputs_;
  std::size_t bytes_;
};

}  // namespace abbe
