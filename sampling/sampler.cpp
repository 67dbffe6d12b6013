#include "sampling/sampler.h"

#include <bit>
#include <cstddef>

namespace abbe {
namespace {

using Point = std::array<std::uint32_t, 4>;

// One 32-bit number for each dimension of two groups, held as one vector of the machine.
using Lanes [[gnu::vector_size(32)]] = std::uint32_t;
using Bytes [[gnu::vector_size(32)]] = std::uint8_t;

constexpr std::uint32_t swap_bytes(std::uint32_t x) {
  return __builtin_bswap32(x);
}
inline Lanes swap_bytes(Lanes x) {
  const auto bytes = std::bit_cast<Bytes>(x);
  return std::bit_cast<Lanes>(__builtin_shufflevector(bytes, bytes, 3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15,
                                                      14, 13, 12, 19, 18, 17, 16, 23, 22, 21, 20, 27, 26, 25,
                                                      24, 31, 30, 29, 28));
}

template <typename T>
constexpr T reverse_bits(T x) {
  x = ((x & 0x55555555U) << 1) | ((x >> 1) & 0x55555555U);
  x = ((x & 0x33333333U) << 2) | ((x >> 2) & 0x33333333U);
  x = ((x & 0x0f0f0f0fU) << 4) | ((x >> 4) & 0x0f0f0f0fU);
  return swap_bytes(x);
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

// The same by bytes: four look-ups make a point, its bits reversed.
constexpr std::array<std::array<Point, 256>, 4> sobol_bytes() {
  constexpr std::array<Point, 32> kColumns = sobol_columns();
  std::array<std::array<Point, 256>, 4> table{};
  for (std::size_t byte = 0; byte < 4; ++byte)
    for (std::size_t value = 1; value < 256; ++value) {
      std::size_t bit = 0;
      while (!((value >> bit) & 1U)) ++bit;
      for (std::size_t d = 0; d < 4; ++d)
        table[byte][value][d] =
            table[byte][value & (value - 1)][d] ^ reverse_bits(kColumns[8 * byte + bit][d]);
    }
  return table;
}

constexpr std::array<std::array<Point, 256>, 4> kSobol = sobol_bytes();

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

// A permutation in which each bit depends only on itself and lower bits [Laine2011]; between two bit
// reversals, the first of which the caller has done, it is an Owen scrambling of a point, or a nested uniform
// shuffle of an index.
template <typename T>
constexpr T owen_scramble(T reversed, T seed) {
  T x = reversed + seed;
  x ^= x * 0x6c50b47cU;
  x ^= x * 0xb82f1e52U;
  x ^= x * 0xc7afe638U;
  x ^= x * 0x8d22f6e6U;
  return reverse_bits(x);
}

// Point i of the sequence, its bits reversed.
Point sobol_point(std::uint32_t i) {
  Point x;
  for (std::size_t d = 0; d < 4; ++d)
    x[d] = kSobol[0][i & 255U][d] ^ kSobol[1][(i >> 8) & 255U][d] ^ kSobol[2][(i >> 16) & 255U][d] ^
           kSobol[3][i >> 24][d];
  return x;
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
  const std::array<std::uint32_t, 2> keys{combine(key_, first), combine(key_, first + 1)};
  const std::array<Point, 2> points{sobol_point(owen_scramble(reversed_index_, keys[0])),
                                    sobol_point(owen_scramble(reversed_index_, keys[1]))};
  const Lanes key{keys[0], keys[0], keys[0], keys[0], keys[1], keys[1], keys[1], keys[1]};
  constexpr Lanes kDimensions{1, 2, 3, 4, 1, 2, 3, 4};
  const Lanes x = owen_scramble(std::bit_cast<Lanes>(points), combine(key, kDimensions));
  using Floats [[gnu::vector_size(32)]] = float;
  using Signed [[gnu::vector_size(32)]] = std::int32_t;  // there is an instruction for these
  const Floats unit = __builtin_convertvector(std::bit_cast<Signed>(x >> 8), Floats) * 0x1p-24F;
  return std::bit_cast<std::array<std::array<float, 4>, 2>>(unit);
}

std::array<float, 4> Sampler::group(std::uint32_t group) const {
  return two_groups(group)[0];
}

}  // namespace abbe
