#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace abbe::test {

/// The bytes of a little-endian TIFF with entries of its first folder made others, as other programs write
/// them.
struct TiffEntries {
  std::string bytes;

  /// Makes the entry of `tag` one of `as`, which holds a number of 16 bits.
  void set_short(std::uint16_t tag, std::uint16_t as, std::uint16_t value) {
    constexpr std::uint32_t kShort = 3;
    set(entry_of(tag), {{2, as}, {2, kShort}, {4, 1}, {4, value}});
  }
  /// Makes the numbers of `tag` these of 32 bits, behind all else.
  void set_longs(std::uint16_t tag, const std::vector<std::uint32_t>& values) { set_longs(tag, tag, values); }
  /// Makes the entry of `tag` one of `as` with these.
  void set_longs(std::uint16_t tag, std::uint16_t as, const std::vector<std::uint32_t>& values) {
    constexpr std::uint32_t kLong = 4;
    const auto at = static_cast<std::uint32_t>(bytes.size());
    set(entry_of(tag), {{2, as}, {2, kLong}, {4, static_cast<std::uint32_t>(values.size())}, {4, at}});
    bytes.resize(at + 4 * values.size());
    for (std::size_t i = 0; i < values.size(); ++i) set(at + 4 * i, {{4, values[i]}});
  }
  /// Makes the entry of `tag` one of `as` with these bytes of no type, behind all else.
  void set_bytes(std::uint16_t tag, std::uint16_t as, const std::string& values) {
    constexpr std::uint32_t kUndefined = 7;
    const auto at = static_cast<std::uint32_t>(bytes.size());
    set(entry_of(tag), {{2, as}, {2, kUndefined}, {4, static_cast<std::uint32_t>(values.size())}, {4, at}});
    bytes += values;
  }
  /// The value of an entry, or where its values are.
  [[nodiscard]] std::uint32_t value_of(std::uint16_t tag) const { return number(entry_of(tag) + 8, 4); }
  /// Where its first folder is.
  [[nodiscard]] std::uint32_t first_folder() const { return number(4, 4); }
  /// Makes a folder the first, of numbers of 32 bits by their tags, which rise; no other follows it.
  void put_first(const std::vector<std::pair<std::uint16_t, std::uint32_t>>& entries) {
    constexpr std::uint32_t kLong = 4;
    bytes.resize(bytes.size() + bytes.size() % 2);
    const std::size_t at = bytes.size();
    std::vector<Field> fields{{2, static_cast<std::uint32_t>(entries.size())}};
    for (const auto& [tag, value] : entries)
      fields.insert(fields.end(), {{2, tag}, {2, kLong}, {4, 1}, {4, value}});
    fields.push_back({4, 0});
    bytes.resize(at + 6 + 12 * entries.size());
    set(at, fields);
    set_number(4, static_cast<std::uint32_t>(at));
  }
  /// Makes the bytes at a place those of a number of 32 bits.
  void set_number(std::size_t at, std::uint32_t value) { set(at, {{4, value}}); }

 private:
  struct Field {
    std::size_t size;
    std::uint32_t value;
  };

  [[nodiscard]] std::uint32_t number(std::size_t at, std::size_t size) const {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < size; ++i)
      value |= static_cast<std::uint32_t>(static_cast<std::uint8_t>(bytes.at(at + i))) << (8 * i);
    return value;
  }
  void set(std::size_t at, const std::vector<Field>& fields) {
    for (const Field& field : fields)
      for (std::size_t i = 0; i < field.size; ++i, ++at)
        bytes.at(at) = static_cast<char>(field.value >> (8 * i) & 0xFFU);
  }
  [[nodiscard]] std::size_t entry_of(std::uint16_t tag) const {
    constexpr std::size_t kEntry = 12;
    const std::size_t folder = first_folder();
    for (std::size_t i = 0; i < number(folder, 2); ++i)
      if (const std::size_t at = folder + 2 + kEntry * i; number(at, 2) == tag) return at;
    ADD_FAILURE() << "no tag " << tag;
    return folder + 2;
  }
};

}  // namespace abbe::test
