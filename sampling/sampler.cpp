#include "sampling/sampler.h"

#include <immintrin.h>

#include <bit>
#include <cstddef>

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

// Generator matrices of the first four Sobol dimensions: bit b of the index flips column b. The recurrence
// and its initial numbers are those of [Joe2008] (primitive polynomials 1, x+1, x^2+x+1, x^3+x+1).
constexpr std::array<Point, 32> sobol_columns() {
  constexpr std::array<std::uint32_t, 4> kDegree{0, 1, 2, 3};
  constexpr std::array<std::uint32_t, 4> kCoefficients{0, 0, 1, 1};
  constexpr std::array<std::array<std::uint32_t, 3>, 4> kInitial{{{}, {1, 0, 0}, {1, 3, 0}, {1, 3, 1}}};
  std::array<Point, 32> columns{};
  for (std::size_t d = 0; d < 4; ++d)
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

// The same by bytes of the index, whose bits are reversed: four look-ups make a point, its bits reversed too.
constexpr std::array<std::array<Point, 256>, 4> sobol_bytes() {
  constexpr std::array<Point, 32> kColumns = sobol_columns();
  std::array<std::array<Point, 256>, 4> table{};
  for (std::size_t byte = 0; byte < 4; ++byte)
    for (std::size_t value = 1; value < 256; ++value) {
      std::size_t bit = 0;
      while (!((value >> bit) & 1U)) ++bit;
      for (std::size_t d = 0; d < 4; ++d)
        table[byte][value][d] =
            table[byte][value & (value - 1)][d] ^ reverse_bits(kColumns[31 - (8 * byte + bit)][d]);
    }
  return table;
}

alignas(Quad) constexpr std::array<std::array<Point, 256>, 4> kSobol = sobol_bytes();

template <typename T>
constexpr T mix(T x) {  // a bijection with full avalanche [Wellons2018]
  x ^= x >> 16;
  x *= 0x7feb352dU;
  x ^= x >> 15;
  x *= 0x846ca68bU;
  x ^= x >> 16;
  return x;
}

template <typename T>
constexpr T combine(T a, T b) {
  return mix(a ^ (mix(b) + 0x9e3779b9U));
}

// A permutation in which each bit depends only on itself and lower bits [Laine2011]: between two bit
// reversals it is an Owen scrambling of a point, or a nested uniform shuffle of an index.
template <typename T>
constexpr T owen_scramble(T reversed, T seed) {
  T x = reversed + seed;
  x ^= x * 0x6c50b47cU;
  x ^= x * 0xb82f1e52U;
  x ^= x * 0xc7afe638U;
  x ^= x * 0x8d22f6e6U;
  return x;
}

// A point of the sequence, its bits and those of its index reversed.
Quad sobol_point(std::uint32_t reversed) {
  const auto part = [](const std::array<Point, 256>& table, std::uint32_t byte) {
    return std::bit_cast<Quad>(table[byte & 255U]);
  };
  return part(kSobol[0], reversed) ^ part(kSobol[1], reversed >> 8) ^ part(kSobol[2], reversed >> 16) ^
         part(kSobol[3], reversed >> 24);
}

// What the numbers of a group are made of: a point of the sequence, its bits reversed, and what scrambles it.
struct GroupPoint {
  GroupPoint(std::uint32_t sampler_key, std::uint32_t reversed_index, std::uint32_t group)
      : key(combine(sampler_key, group)), point(sobol_point(owen_scramble(reversed_index, key))) {}
  std::uint32_t key;
  Quad point;
};

std::array<std::array<float, 4>, 2> numbers(const GroupPoint& a, const GroupPoint& b) {
  constexpr Lanes kDimensions{1, 2, 3, 4, 1, 2, 3, 4};
  const Lanes keys = join(Quad{a.key, a.key, a.key, a.key}, Quad{b.key, b.key, b.key, b.key});
  const Lanes x = reverse_bits(owen_scramble(join(a.point, b.point), combine(keys, kDimensions)));
  using Floats [[gnu::vector_size(32)]] = float;
  using Signed [[gnu::vector_size(32)]] = std::int32_t;  // there is an instruction for these
  const Floats unit = __builtin_convertvector(std::bit_cast<Signed>(x >> 8), Floats) * 0x1p-24F;
  return std::bit_cast<std::array<std::array<float, 4>, 2>>(unit);
}

}  // namespace

Sampler::Sampler(std::uint64_t seed, Purpose purpose, std::uint32_t replicate, std::uint32_t stream,
                 std::uint32_t index)
    : key_(combine(
          combine(combine(combine(static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)),
                          static_cast<std::uint32_t>(purpose)),
                  replicate),
          stream)),
      reversed_index_(reverse_bits(index)) {}

std::array<std::array<float, 4>, 2> Sampler::two_groups(std::uint32_t first) const {
  return numbers({key_, reversed_index_, first}, {key_, reversed_index_, first + 1});
}

Sampler Sampler::branch(std::uint32_t number) const {
  Sampler part = *this;
  part.key_ = combine(key_, ~number);  // groups are counted from 0 on
  return part;
}

std::array<float, 4> Sampler::group(std::uint32_t group) const {
  const GroupPoint point(key_, reversed_index_, group);
  return numbers(point, point)[0];
}

}  // namespace abbe
