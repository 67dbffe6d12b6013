#include "sampling/sampler.h"

#include <bit>
#include <cstddef>

#include <immintrin.h>

namespace abbe {
namespace {

using Point = std::array<std::uint32_t, 4>;

// One 32-bit integer for each dimension of one group (`FourWords`) or of two groups (`Lanes`), in one SIMD
// register.
using FourWords [[gnu::vector_size(16)]] = std::uint32_t;
using Lanes [[gnu::vector_size(32)]] = std::uint32_t;

Lanes join(FourWords a, FourWords b) {
  return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
}

constexpr std::uint32_t reverse_bits(std::uint32_t x) {
  x = ((x & 0x55555555U) << 1) | ((x >> 1) & 0x55555555U);
  x = ((x & 0x33333333U) << 2) | ((x >> 2) & 0x33333333U);
  x = ((x & 0x0f0f0f0fU) << 4) | ((x >> 4) & 0x0f0f0f0fU);
  return __builtin_bswap32(x);
}

// Reverses the order of the bytes, then the bits of each byte by a table for each half of it.
Lanes reverse_bits(Lanes x) {
  using Bytes [[gnu::vector_size(32)]] = std::uint8_t;
  const auto look_up = [](Bytes table, Bytes at) {
    return std::bit_cast<Bytes>(
        _mm256_shuffle_epi8(std::bit_cast<__m256i>(table), std::bit_cast<__m256i>(at)));
  };
  constexpr Bytes kSwapped{3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12,
                           3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12};
  constexpr Bytes kReversed{0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15,
                            0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15};
  const Bytes swapped = look_up(std::bit_cast<Bytes>(x), kSwapped);
  return std::bit_cast<Lanes>(look_up(kReversed << 4, swapped & 15) | look_up(kReversed, swapped >> 4));
}

constexpr std::size_t kDimensions = 4;

// Generator matrices of five Sobol dimensions; the last one selects the replicate. Bit b of the index adds
// column b. The recurrence is that of [Joe2008], with the primitive polynomials 1, x+1, x^2+x+1, x^3+x+1 and
// x^3+x^2+1. The initial direction numbers are those of [Joe2008] too, except for the last dimension: 1, 1,
// 5. A search over the ranks of the matrices chose these. With them, the fewest points of a replicate of 2, 4
// or 8 fall into the same one- or two-dimensional box.
constexpr std::array<std::array<std::uint32_t, kDimensions + 1>, 32> sobol_columns() {
  constexpr std::array<std::uint32_t, kDimensions + 1> kDegree{0, 1, 2, 3, 3};
  constexpr std::array<std::uint32_t, kDimensions + 1> kCoefficients{0, 0, 1, 1, 2};
  constexpr std::array<std::array<std::uint32_t, 3>, kDimensions + 1> kInitial{
      {{}, {1, 0, 0}, {1, 3, 0}, {1, 3, 1}, {1, 1, 5}}};
  std::array<std::array<std::uint32_t, kDimensions + 1>, 32> columns{};
  for (std::size_t d = 0; d <= kDimensions; ++d)
    for (std::uint32_t b = 0; b < 32; ++b) {
      const std::uint32_t degree = kDegree[d];
      if (d == 0) {
        columns[b][d] = 1U << (31 - b);
      } else if (b < degree) {
        columns[b][d] = kInitial[d][b] << (31 - b);
      } else {
        std::uint32_t v = columns[b - degree][d] ^ (columns[b - degree][d] >> degree);
        for (std::uint32_t k = 1; k < degree; ++k)
          if ((kCoefficients[d] >> (degree - 1 - k)) & 1U) v ^= columns[b - k][d];
        columns[b][d] = v;
      }
    }
  return columns;
}

// A point of all five dimensions with its bits reversed. The lowest bits of the last dimension are then the
// number of the replicate.
struct IndexedPoint {
  Point numbers;
  std::uint32_t replicate;

  constexpr IndexedPoint operator^(const IndexedPoint& more) const {
    const Point& a = numbers;
    const Point& b = more.numbers;
    return {{a[0] ^ b[0], a[1] ^ b[1], a[2] ^ b[2], a[3] ^ b[3]}, replicate ^ more.replicate};
  }
};

constexpr std::array<IndexedPoint, 32> kColumns = [] {
  const auto numbers = sobol_columns();
  std::array<IndexedPoint, 32> columns{};
  for (std::size_t b = 0; b < 32; ++b) {
    for (std::size_t d = 0; d < kDimensions; ++d) columns[b].numbers[d] = reverse_bits(numbers[b][d]);
    columns[b].replicate = reverse_bits(numbers[b][kDimensions]);
  }
  return columns;
}();

constexpr std::size_t kMaxDigits = 3;

// First point of each of eight replicates: one of the first eight points of the sequence. It is also the
// first point for fewer replicates.
alignas(FourWords) constexpr std::array<Point, 1 << kMaxDigits> kFirstPoints = [] {
  std::array<Point, 1 << kMaxDigits> points{};
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    IndexedPoint point{};
    for (std::size_t b = 0; b < kMaxDigits; ++b)
      if ((i >> b) & 1U) point = point ^ kColumns[b];
    points[point.replicate % points.size()] = point.numbers;
  }
  return points;
}();

// Change of the point if bit b of the index within one of 2^digits replicates flips. It combines a later bit
// of the whole sequence with those first bits that leave the point in its replicate.
constexpr Point column_within(std::size_t digits, std::size_t b) {
  if (b + digits >= 32) return {};
  const IndexedPoint& column = kColumns[b + digits];
  return (column ^ IndexedPoint{kFirstPoints[column.replicate % (1U << digits)], 0}).numbers;
}

// Columns tabulated for each byte of the bit-reversed index: four look-ups make a point.
using SobolBytes = std::array<std::array<Point, 256>, 4>;
constexpr SobolBytes sobol_bytes(std::size_t digits) {
  SobolBytes table{};
  for (std::size_t byte = 0; byte < 4; ++byte)
    for (std::size_t value = 1; value < 256; ++value) {
      const auto bit = static_cast<std::size_t>(std::countr_zero(value));
      const Point column = column_within(digits, 31 - (8 * byte + bit));
      for (std::size_t d = 0; d < kDimensions; ++d)
        table[byte][value][d] = table[byte][value & (value - 1)][d] ^ column[d];
    }
  return table;
}

// Indexed by the number of binary digits that number a replicate.
alignas(FourWords) constexpr std::array<SobolBytes, kMaxDigits + 1> kSobol{sobol_bytes(0), sobol_bytes(1),
                                                                           sobol_bytes(2), sobol_bytes(3)};

// Permutation in which each bit depends only on itself and on lower bits [Laine2011]. Applied between two bit
// reversals, it is an Owen scrambling.
template <typename T>
constexpr T owen_scramble(T reversed, T seed) {
  T x = reversed + seed;
  x ^= x * 0x6c50b47cU;
  x ^= x * 0xb82f1e52U;
  x ^= x * 0xc7afe638U;
  x ^= x * 0x8d22f6e6U;
  return x;
}

// Shuffles a bit-reversed index; here, too, each bit depends only on itself and on lower bits. A product with
// an even number leaves trailing zeros and the first bit after them unchanged. The first eight indices
// therefore stay the first eight, and the first 2^k stay the first for any larger k. Replicates that are
// shuffled independently then fill the same blocks of the sequence.
constexpr std::uint32_t shuffle(std::uint32_t x, std::uint32_t seed) {
  x ^= x * (seed & ~1U);
  x ^= x * 0x6c50b47cU;
  x ^= x * 0xb82f1e52U;
  x ^= x * (std::rotl(seed, 16) & ~1U);
  x ^= x * 0xc7afe638U;
  x ^= x * 0x8d22f6e6U;
  constexpr std::uint32_t kBelowEight = 0xe0000000U;
  return x ^ (seed & kBelowEight);
}

// Point of a replicate with bit-reversed coordinates. `reversed` is the bit-reversed index within the
// replicate.
FourWords sobol_point(std::uint32_t reversed, Replicate replicate) {
  const SobolBytes& table = kSobol[static_cast<std::size_t>(std::countr_zero(replicate.count))];
  const auto part = [&table, reversed](std::size_t byte) {
    return std::bit_cast<FourWords>(table[byte][(reversed >> (8 * byte)) & 255U]);
  };
  return part(0) ^ part(1) ^ part(2) ^ part(3) ^ std::bit_cast<FourWords>(kFirstPoints[replicate.number]);
}

// A Sobol point with bit-reversed coordinates, and the key that scrambles it. The key also permutes the
// replicates of the group at random, and the order of the points in each.
struct GroupPoint {
  GroupPoint(std::uint32_t sampler_key, std::uint32_t reversed_index, Replicate replicate,
             std::uint32_t group)
      : key(combine(sampler_key, group)),
        point(sobol_point(shuffle(reversed_index, mix(key + replicate.number + 1)),
                          {replicate.number ^ (key & (replicate.count - 1)), replicate.count})) {}
  std::uint32_t key;
  FourWords point;
};

std::array<std::array<float, 4>, 2> numbers(const GroupPoint& a, const GroupPoint& b) {
  constexpr Lanes kNumbers{1, 2, 3, 4, 1, 2, 3, 4};
  const Lanes keys = join(FourWords{a.key, a.key, a.key, a.key}, FourWords{b.key, b.key, b.key, b.key});
  const Lanes x = reverse_bits(owen_scramble(join(a.point, b.point), combine(keys, kNumbers)));
  using Floats [[gnu::vector_size(32)]] = float;
  using Signed [[gnu::vector_size(32)]] = std::int32_t;  // conversion from signed integers is one instruction
  const Floats unit = __builtin_convertvector(std::bit_cast<Signed>(x >> 8), Floats) * 0x1p-24F;
  return std::bit_cast<std::array<std::array<float, 4>, 2>>(unit);
}

}  // namespace

Sampler::Sampler(std::uint64_t seed, Purpose purpose, std::uint32_t sequence, std::uint32_t stream,
                 std::uint32_t index, Replicate replicate)
    : key_(combine(
          combine(combine(combine(static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)),
                          static_cast<std::uint32_t>(purpose)),
                  sequence),
          stream)),
      reversed_index_(reverse_bits(index)),
      replicate_(replicate) {}

std::array<std::array<float, 4>, 2> Sampler::two_groups(std::uint32_t first) const {
  return numbers({key_, reversed_index_, replicate_, first}, {key_, reversed_index_, replicate_, first + 1});
}

Sampler Sampler::branch(std::uint32_t number) const {
  Sampler child = *this;
  child.key_ = combine(key_, ~number);  // groups count up from 0, so branches count down
  return child;
}

Sampler Sampler::split_child(std::uint32_t number, int bits) const {
  Sampler child = *this;
  child.reversed_index_ = (reversed_index_ >> bits) | reverse_bits(number);
  return child;
}

std::array<float, 4> Sampler::group(std::uint32_t group) const {
  const GroupPoint point(key_, reversed_index_, replicate_, group);
  return numbers(point, point)[0];
}

}  // namespace abbe
