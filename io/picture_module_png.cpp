// What a PNG's own checksums say of it.
#include <array>
#include <cstdint>
#include <fstream>
#include <vector>

#include <boost/crc.hpp>

#include "io/picture_module.h"

namespace abbe::picture_module {
namespace {

std::uint32_t big_endian(const std::array<char, 4>& bytes) {
  std::uint32_t number = 0;
  for (const char byte : bytes) number = number << 8U | static_cast<std::uint8_t>(byte);
  return number;
}

// The length of a chunk, its type, its data and the checksum of type and data.
bool is_sound_chunk(std::istream& file, std::uint64_t left, std::array<char, 4>& type) {
  constexpr std::uint64_t kAround = 12;  // bytes beside the data
  std::array<char, 4> length{};
  std::array<char, 4> checksum{};
  if (left < kAround || !file.read(length.data(), 4) || !file.read(type.data(), 4)) return false;
  if (big_endian(length) > left - kAround) return false;
  std::vector<char> data(big_endian(length));
  boost::crc_32_type crc;
  crc.process_bytes(type.data(), type.size());
  if (!data.empty()) file.read(data.data(), static_cast<std::streamsize>(data.size()));
  crc.process_bytes(data.data(), data.size());
  return file.read(checksum.data(), 4) && crc.checksum() == big_endian(checksum);
}

}  // namespace

bool is_damaged_png(const std::string& path) {
  constexpr std::array<char, 8> kSignature{'\x89', 'P', 'N', 'G', '\r', '\n', '\x1a', '\n'};
  constexpr std::array<char, 4> kEnd{'I', 'E', 'N', 'D'};
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const auto size = static_cast<std::uint64_t>(file.tellg());
  file.seekg(0);
  std::array<char, 8> signature{};
  if (!file.read(signature.data(), signature.size()) || signature != kSignature) return false;
  std::array<char, 4> type{};
  while (type != kEnd)
    if (!is_sound_chunk(file, size - static_cast<std::uint64_t>(file.tellg()), type)) return true;
  return false;
}

}  // namespace abbe::picture_module
