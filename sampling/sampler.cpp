#include "sampling/sampler.h"

#include <cstddef>

namespace abbe {
namespace {

using Point = std::array<std::uint32_t, 4>;

constexpr std::uint32_t reverse_bits(std::uint32_t x) {
  x = ((x & 0x55555555U) << 1) | ((x >> 1) & 0x55555555U);
  x = ((x & 0x33333333U) << 2) | ((x >> 2) & 0x33333333U);
  x = ((x & 0x0f0f0f0fU) << 4) | ((x >> 4) & 0x0f0f0f0fU);
  return __builtin_bswap32(x);
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

constexpr std::uint32_t mix(std::uint32_t x) {  // a bijection with full avalanche [Wellons2018]
  x ^= x >> 16;
  x *= 0x7feb352dU;
  x ^= x >> 15;
  x *= 0x846ca68bU;
  x ^= x >> 16;
  return x;
}

constexpr std::uint32_t combine(std::uint32_t a, std::uint32_t b) {
  return mix(a ^ (mix(b) + 0x9e3779b9U));
}

// A permutation in which each bit depends only on itself and lower bits [Laine2011]; between two bit
// reversals, the first of which the caller has done, it is an Owen scrambling of a point, or a nested uniform
// shuffle of an index.
constexpr std::uint32_t owen_scramble(std::uint32_t reversed, std::uint32_t seed) {
  std::uint32_t x = reversed + seed;
  x ^= x * 0x6c50b47cU;
  x ^= x * 0xb82f1e52U;
  x ^= x * 0xc7afe638U;
  x ^= x * 0x8d22f6e6U;
  return reverse_bits(x);
}

constexpr float to_unit(std::uint32_t x) {
  return static_cast<float>(x >> 8) * 0x1p-24F;
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

std::array<float, 4> Sampler::group(std::uint32_t group) const {
  const std::uint32_t key = combine(key_, group);
  const std::uint32_t i = owen_scramble(reversed_index_, key);
  std::array<float, 4> point;
  for (std::uint32_t d = 0; d < 4; ++d) {
    const std::uint32_t x = kSobol[0][i & 255U][d] ^ kSobol[1][(i >> 8) & 255U][d] ^
                            kSobol[2][(i >> 16) & 255U][d] ^ kSobol[3][i >> 24][d];
    point[d] = to_unit(owen_scramble(x, combine(key, d + 1)));
  }
  return point;
}

}  // namespace abbe
