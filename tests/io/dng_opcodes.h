#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

namespace abbe::test {

inline constexpr std::uint16_t kOpcodeList1 = 51008;
inline constexpr std::uint16_t kOpcodeList2 = 51009;
inline constexpr std::uint16_t kOpcodeList3 = 51022;

/// Bytes of an opcode list of a DNG, the most significant first.
struct OpcodeBytes {
  std::string bytes;

  OpcodeBytes& integer(std::uint32_t number) {
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(number >> shift & 0xFFU);
    return *this;
  }
  OpcodeBytes& integers(const std::vector<std::uint32_t>& numbers) {
    for (const std::uint32_t number : numbers) integer(number);
    return *this;
  }
  OpcodeBytes& real32(float number) { return integer(std::bit_cast<std::uint32_t>(number)); }
  OpcodeBytes& real64(double number) {
    const auto all = std::bit_cast<std::uint64_t>(number);
    return integer(static_cast<std::uint32_t>(all >> 32)).integer(static_cast<std::uint32_t>(all));
  }
};

/// A list of one opcode with these parameters.
inline std::string opcode_list(std::uint32_t id, const std::string& parameters, bool is_optional = false) {
  OpcodeBytes list;
  list.integers({1, id, 0x01030000, is_optional ? 1U : 0U, static_cast<std::uint32_t>(parameters.size())});
  return list.bytes + parameters;
}

/// An area of all rows and columns of an image below 100 pixels, in planes from the first.
inline OpcodeBytes opcode_area(std::uint32_t first_plane, std::uint32_t planes) {
  return OpcodeBytes().integers({0, 0, 100, 100, first_plane, planes, 1, 1});
}

/// A list of a GainMap with the gains of a row of points, over the whole width of an image.
inline std::string gain_map(const std::vector<float>& gains, std::uint32_t first_plane = 0,
                            std::uint32_t planes = 1, bool is_optional = false) {
  OpcodeBytes map = opcode_area(first_plane, planes);
  map.integers({1, static_cast<std::uint32_t>(gains.size())});
  map.real64(1).real64(gains.size() > 1 ? 1.0 / static_cast<double>(gains.size() - 1) : 1);
  map.real64(0).real64(0).integer(1);
  for (const float gain : gains) map.real32(gain);
  return opcode_list(9, map.bytes, is_optional);
}

/// A list of a MapPolynomial with the coefficients of 1, x, x^2 and so on.
inline std::string map_polynomial(const std::vector<double>& coefficients) {
  OpcodeBytes map = opcode_area(0, 1);
  map.integer(static_cast<std::uint32_t>(coefficients.size() - 1));
  for (const double coefficient : coefficients) map.real64(coefficient);
  return opcode_list(8, map.bytes);
}

}  // namespace abbe::test
