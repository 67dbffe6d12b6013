#include "sampling/sampler.h"

#include <immintrin.h>

#include <bit>
#include <cstddef>

#include "sampling/mix.h"

namespace abbe {
namespace {

using Point = std::array<std::uint32_t, 4>;

// One 32-bit number for each dimension of a group, or of two, held as one vector of the machine.
using Quad [[gnu::vector_size(16)]] = std::uint32_t;
using Lanes [[gnu::vector_size(32)]] = std::uint32_t;

Lanes join(Quad a, Quad b) {
  return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
}

constexpr std::uint32_t reverse_bits(std::uint32_t x) {
  x = ((x & 0x55555555U) << 1) | ((x >> 1) & 0x55555555U);
  x = ((x & 0x33333333U) << 2) | ((x >> 2) & 0x33333333U);
  x = ((x & 0x0f0f0f0fU) << 4) | ((x >> 4) & 0x0f0f0f0fU);
  return __builtin_bswap32(x);
}

// Bytes change places, then the halves of each, which a table reverses.
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

// Generator matrices of the first five Sobol dimensions, of which the last parts replicates: bit b of the
// index flips column b. The recurrence and, but for the last, the initial numbers are those of [Joe2008]
// (primitive polynomials 1, x+1, x^2+x+1, x^3+x+1, x^3+x^2+1). By 1, 1, 5 for the last the fewest points of a
// replicate of 2, 4 or 8 share boxes of one or of two dimensions (a search by ranks of the matrices).
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

// The same with bits of numbers reversed: of the last dimension the lowest are then the replicate.
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

constexpr std::size_t kMostDigits = 3;

// The first point of each replicate of eight, and so of fewer: one of the first eight of the sequence.
alignas(Quad) constexpr std::array<Point, 1 << kMostDigits> kFirstPoints = [] {
  std::array<Point, 1 << kMostDigits> points{};
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    IndexedPoint point{};
    for (std::size_t b = 0; b < kMostDigits; ++b)
      if ((i >> b) & 1U) point = point ^ kColumns[b];
    points[point.replicate % points.size()] = point.numbers;
  }
  return points;
}();

// What bit b of an index within one of 2^digits replicates flips: a later bit of the whole sequence's, and
// those first ones that keep the point in its replicate.
constexpr Point column_within(std::size_t digits, std::size_t b) {
  if (b + digits >= 32) return {};
  const IndexedPoint& column = kColumns[b + digits];
  return (column ^ IndexedPoint{kFirstPoints[column.replicate % (1U << digits)], 0}).numbers;
}

// The same by bytes of the index, whose bits are reversed too: four look-ups make a point.
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

// By the digits that number a replicate.
alignas(Quad) constexpr std::array<SobolBytes, kMostDigits + 1> kSobol{sobol_bytes(0), sobol_bytes(1),
                                                                       sobol_bytes(2), sobol_bytes(3)};

// A permutation in which each bit depends only on itself and lower bits [Laine2011]: between two bit
// reversals it is an Owen scrambling of a point.
template <typename T>
constexpr T owen_scramble(T reversed, T seed) {
  T x = reversed + seed;
  x ^= x * 0x6c50b47cU;
  x ^= x * 0xb82f1e52U;
  x ^= x * 0xc7afe638U;
  x ^= x * 0x8d22f6e6U;
  return x;
}

// A shuffle of an index, its bits reversed, in which each depends only on itself and lower ones too; but
// products by even numbers leave zeros at the low end as they are, and the first one after them. So the first
// eight indices stay the first, and the first 2^k for any more: replicates that are shuffled each by itself
// fill the same blocks of the sequence.
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

// A point of a replicate, the bits of its numbers and of its index there reversed.
Quad sobol_point(std::uint32_t reversed, Replicate replicate) {
  const SobolBytes& table = kSobol[static_cast<std::size_t>(std::countr_zero(replicate.of))];
  const auto part = [&table, reversed](std::size_t byte) {
    return std::bit_cast<Quad>(table[byte][(reversed >> (8 * byte)) & 255U]);
  };
  return part(0) ^ part(1) ^ part(2) ^ part(3) ^ std::bit_cast<Quad>(kFirstPoints[replicate.number]);
}

// What the numbers of a group are made of: a point of the sequence, its bits reversed, and what scrambles it.
// Which replicate of the sampler's is which of the group's is chance, and in what order it has its points.
struct GroupPoint {
  GroupPoint(std::uint32_t sampler_key, std::uint32_t reversed_index, Replicate replicate,
             std::uint32_t group)
      : key(combine(sampler_key, group)),
        point(sobol_point(shuffle(reversed_index, mix(key + replicate.number + 1)),
                          {replicate.number ^ (key & (replicate.of - 1)), replicate.of})) {}
  std::uint32_t key;
  Quad point;
};

std::array<std::array<float, 4>, 2> numbers(const GroupPoint& a, const GroupPoint& b) {
  constexpr Lanes kNumbers{1, 2, 3, 4, 1, 2, 3, 4};
  const Lanes keys = join(Quad{a.key, a.key, a.key, a.key}, Quad{b.key, b.key, b.key, b.key});
  const Lanes x = reverse_bits(owen_scramble(join(a.point, b.point), combine(keys, kNumbers)));
  using Floats [[gnu::vector_size(32)]] = float;
  using Signed [[gnu::vector_size(32)]] = std::int32_t;  // there is an instruction for these
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
  Sampler part = *this;
  part.key_ = combine(key_, ~number);  // groups are counted from 0 on
  return part;
}

Sampler Sampler::part(std::uint32_t number, int bits) const {
  Sampler part = *this;
  part.reversed_index_ = (reversed_index_ >> bits) | reverse_bits(number);
  return part;
}

std::array<float, 4> Sampler::group(std::uint32_t group) const {
  const GroupPoint point(key_, reversed_index_, replicate_, group);
  return numbers(point, point)[0];
}

}  // namespace abbe
