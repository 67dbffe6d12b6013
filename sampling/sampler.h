#pragma once

#include <array>
#include <cstdint>

namespace abbe {

/// What a sequence of random numbers is for; sequences of different purposes are independent.
/// Those of `sample` are for what all paths of a sample have in common.
enum class Purpose : std::uint32_t { camera = 1, light = 2, pilot = 3, sample = 4 };

/// Which of `of` replicates, 1, 2, 4 or 8, that a sequence is parted into.
struct Replicate {
  std::uint32_t number = 0;
  std::uint32_t of = 1;
};

/// Owen-scrambled Sobol points in groups of four dimensions, a pure function of seed, purpose, sequence,
/// stream (a pixel, say), sample index, replicate and group: nothing is consumed, so no path depends on what
/// another asked for. Within one group the points of a stream are a (0, 2)-like low-discrepancy sequence;
/// groups are padded by independent shuffles. [Burley2020]
///
/// The R replicates of a stream are the slices of each group along one more dimension of Sobol's, from r/R up
/// to (r + 1)/R. So the points of each are a low-discrepancy sequence, and the first n of all, n being 8 or a
/// higher power of two, are the Rn points of one. What all R find together has thus less variance than R
/// independent sequences leave, and as the slices repel each other, the spread of their means tells more than
/// it has, rather than less.
class Sampler {
 public:
  /// Indices below 2^kIndexBits have points of their own in any replicate, those of parts counted.
  static constexpr int kIndexBits = 29;

  Sampler(std::uint64_t seed, Purpose purpose, std::uint32_t sequence, std::uint32_t stream,
          std::uint32_t index, Replicate replicate = {});

  /// Four numbers in [0, 1).
  [[nodiscard]] std::array<float, 4> group(std::uint32_t group) const;
  /// The numbers of two groups that follow each other, at the cost of one.
  [[nodiscard]] std::array<std::array<float, 4>, 2> two_groups(std::uint32_t first) const;
  /// Numbers of its own, of the same index, for a part of a path that goes on apart from the others.
  [[nodiscard]] Sampler branch(std::uint32_t number) const;
  /// The numbers of one of the 2^bits parts, below 2^bits, that a path goes on in, from where it does: those
  /// of all parts of all paths follow each other in the same sequence.
  [[nodiscard]] Sampler part(std::uint32_t number, int bits) const;

 private:
  std::uint32_t key_;
  std::uint32_t reversed_index_;
  Replicate replicate_;
};

}  // namespace abbe
