#pragma once

#include <array>
#include <cstdint>

namespace abbe {

/// What a sequence of random numbers is for; sequences of different purposes are independent.
/// Those of `sample` are for what all paths of a sample have in common.
enum class Purpose : std::uint32_t { camera = 1, light = 2, pilot = 3, sample = 4 };

/// Owen-scrambled Sobol points in groups of four dimensions, a pure function of seed, purpose, replicate,
/// stream (a pixel, say), sample index and group: nothing is consumed, so no path depends on what another
/// asked for. Within one group the points of a stream are a (0, 2)-like low-discrepancy sequence; groups are
/// padded by independent shuffles. [Burley2020]
class Sampler {
 public:
  Sampler(std::uint64_t seed, Purpose purpose, std::uint32_t replicate, std::uint32_t stream,
          std::uint32_t index);

  /// Four numbers in [0, 1).
  [[nodiscard]] std::array<float, 4> group(std::uint32_t group) const;
  /// The numbers of two groups that follow each other, at the cost of one.
  [[nodiscard]] std::array<std::array<float, 4>, 2> two_groups(std::uint32_t first) const;
  /// Numbers of its own, of the same index, for a part of a path that goes on apart from the others.
  [[nodiscard]] Sampler branch(std::uint32_t number) const;

 private:
  std::uint32_t key_;
  std::uint32_t reversed_index_;
};

}  // namespace abbe
