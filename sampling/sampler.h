#pragma once

#include <array>
#include <cstdint>

namespace abbe {

/// Purpose of a sequence of random numbers. Sequences of different purposes are independent. The first three
/// are for camera paths, light paths and pilot paths. `sample` is for quantities that all paths of one sample
/// have in common.
enum class Purpose : std::uint32_t { camera = 1, light = 2, pilot = 3, sample = 4 };

/// One of `count` replicates of a sequence. `count` is 1, 2, 4 or 8, and `number` < `count`; the sampler
/// checks neither.
struct Replicate {
  std::uint32_t number = 0;
  std::uint32_t count = 1;
};

/// Owen-scrambled Sobol points in groups of four dimensions [Burley2020]. A point is a pure function of seed,
/// purpose, sequence, stream (such as a pixel), sample index, replicate and group. Nothing is consumed, so no
/// path depends on the random numbers of another. The points of one stream in one group are a (0, 2)-like
/// low-discrepancy sequence. Independent shuffles pad the groups.
///
/// The R replicates of a stream slice each group along one more Sobol dimension, from r/R to (r + 1)/R. The
/// points of each replicate are a low-discrepancy sequence. If n is 8 or a larger power of two, the first n
/// points of all R replicates are the first Rn points of one sequence. Their joint mean therefore has less
/// variance than that of R independent sequences. The slices are negatively correlated, so the spread of
/// their means overestimates this variance rather than underestimates it.
class Sampler {
 public:
  /// Indices below 2^kIndexBits have distinct points in every replicate, including the indices of split
  /// children.
  static constexpr int kIndexBits = 29;

  /// Sampler for the point `index` of a stream, in one replicate. Different values of `sequence` give
  /// independent sequences of one purpose.
  Sampler(std::uint64_t seed, Purpose purpose, std::uint32_t sequence, std::uint32_t stream,
          std::uint32_t index, Replicate replicate = {});

  /// Four random numbers in [0, 1) of a group, multiples of 2^-24. Repeated calls give the same numbers.
  /// Groups count from 0.
  [[nodiscard]] std::array<float, 4> group(std::uint32_t group) const;
  /// The results of `group(first)` and `group(first + 1)`, at the cost of one call.
  [[nodiscard]] std::array<std::array<float, 4>, 2> two_groups(std::uint32_t first) const;
  /// Sampler with independent random numbers and the same index, for one of several continuations of a path.
  /// Each `number`, counted from 0, gives another sampler.
  [[nodiscard]] Sampler branch(std::uint32_t number) const;
  /// Sampler for child `number` < 2^bits of a path that splits into 2^bits children. Its index is `index`
  /// 2^bits + `number`, so that the children of all paths have consecutive points of the same sequence.
  [[nodiscard]] Sampler split_child(std::uint32_t number, int bits) const;

 private:
  std::uint32_t key_;
  std::uint32_t reversed_index_;
  Replicate replicate_;
};

/// Bijection of 32-bit integers with full avalanche [Wellons2018]. T is `std::uint32_t` or a SIMD vector of
/// it.
template <typename T>
constexpr T mix(T x) {
  x ^= x >> 16;
  x *= 0x7feb352dU;
  x ^= x >> 15;
  x *= 0x846ca68bU;
  x ^= x >> 16;
  return x;
}

/// Hash of two integers, which depends on their order.
template <typename T>
constexpr T combine(T a, T b) {
  return mix(a ^ (mix(b) + 0x9e3779b9U));
}

}  // namespace abbe
