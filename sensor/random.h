#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

namespace abbe {

/// Purpose of random numbers in a readout. Different purposes are independent.
enum class ReadoutPurpose : std::uint64_t { fixed_pattern = 1, noise = 2, row_noise = 3 };

/// Random number generator for the distributions of Boost or the standard library: SplitMix64 [Steele2014].
/// Results are uniform over all 64-bit integers. It advances a 64-bit state in steps of the golden ratio and
/// mixes each state.
class SplitMix64 {
 public:
  using result_type = std::uint64_t;

  constexpr explicit SplitMix64(std::uint64_t state) : state_(state) {}
  /// Independent sequence for each purpose, key (such as a serial number or a hash of seed and frame) and
  /// pixel index. No pixel depends on another or on the order of processing.
  constexpr SplitMix64(ReadoutPurpose purpose, std::uint64_t key, std::size_t pixel)
      : state_(mixed(mixed(mixed(static_cast<std::uint64_t>(purpose)) + key) + pixel)) {}

  constexpr std::uint64_t operator()() {
    state_ += kStep;
    return mixed(state_);
  }
  static constexpr std::uint64_t min() { return 0; }
  static constexpr std::uint64_t max() { return std::numeric_limits<std::uint64_t>::max(); }

 private:
  static constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15U;
  static constexpr std::uint64_t mixed(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31);
  }

  std::uint64_t state_;
};

}  // namespace abbe
