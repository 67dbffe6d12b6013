#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

// ICC profiles for tests, of version 2 but for parametric curves [ICC].
namespace abbe::test {

/// A number in so many bytes, the most significant first.
inline std::string in_bytes(std::uint32_t number, int count = 4) {
  std::string bytes;
  for (int i = count - 1; i >= 0; --i) bytes += static_cast<char>(number >> (8 * i) & 0xFFU);
  return bytes;
}

inline std::string fixed_point(double number) {
  return in_bytes(static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(number * 65536))));
}

/// A tag's data after its type.
inline std::string tagged(std::string_view type, const std::string& data) {
  return std::string(type) + std::string(4, '\0') + data;
}

inline std::string xyz_tag(const std::array<double, 3>& xyz) {
  return tagged("XYZ ", fixed_point(xyz[0]) + fixed_point(xyz[1]) + fixed_point(xyz[2]));
}

/// A table of a tone curve; of one number a power in 256ths, of none a straight line.
inline std::string curve_tag(const std::vector<std::uint32_t>& numbers) {
  std::string data = in_bytes(static_cast<std::uint32_t>(numbers.size()));
  for (const std::uint32_t number : numbers) data += in_bytes(number, 2);
  return tagged("curv", data);
}

inline std::string parametric_tag(std::uint32_t type, const std::vector<double>& parameters) {
  std::string data = in_bytes(type, 2) + in_bytes(0, 2);
  for (const double parameter : parameters) data += fixed_point(parameter);
  return tagged("para", data);
}

/// The tone curve of sRGB.
inline std::string srgb_curve() {
  return parametric_tag(3, {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045});
}

using ProfileTags = std::vector<std::pair<std::string, std::string>>;

/// A profile of that name and data colour space, as "RGB " and "GRAY", with those tags.
inline std::string icc_profile(const std::string& name, const std::string& space, ProfileTags tags) {
  tags.emplace_back("desc", tagged("desc", in_bytes(static_cast<std::uint32_t>(name.size() + 1)) + name +
                                               std::string(1 + 4 + 4 + 2 + 1 + 67, '\0')));
  std::string table = in_bytes(static_cast<std::uint32_t>(tags.size()));
  std::string data;
  for (auto& [key, bytes] : tags) {
    bytes.resize((bytes.size() + 3) / 4 * 4);
    table += key + in_bytes(static_cast<std::uint32_t>(132 + 12 * tags.size() + data.size())) +
             in_bytes(static_cast<std::uint32_t>(bytes.size()));
    data += bytes;
  }
  const std::string body = table + data;
  return in_bytes(static_cast<std::uint32_t>(128 + body.size())) + std::string(4, '\0') +
         in_bytes(0x02100000) + "mntr" + space + "XYZ " + std::string(12, '\0') + "acsp" +
         std::string(28, '\0') + fixed_point(0.9642) + fixed_point(1) + fixed_point(0.8249) +
         std::string(48, '\0') + body;
}

/// The tags of three primaries with one tone curve.
inline ProfileTags primaries_and_curve(const std::array<std::array<double, 3>, 3>& xyz,
                                       const std::string& curve) {
  return {{"rXYZ", xyz_tag(xyz[0])}, {"gXYZ", xyz_tag(xyz[1])}, {"bXYZ", xyz_tag(xyz[2])},
          {"rTRC", curve},           {"gTRC", curve},           {"bTRC", curve}};
}

/// Primaries as widespread profiles have them.
inline constexpr std::array<std::array<double, 3>, 3> kSrgbColumns{
    {{0.43607, 0.22249, 0.01392}, {0.38515, 0.71687, 0.09708}, {0.14307, 0.06061, 0.71410}}};
inline constexpr std::array<std::array<double, 3>, 3> kP3Columns{
    {{0.5151, 0.2412, -0.0011}, {0.2920, 0.6922, 0.0419}, {0.1571, 0.0666, 0.7841}}};

/// Puts a profile into a JPEG that has none.
inline void put_profile(const std::filesystem::path& jpeg, const std::string& profile) {
  std::ifstream file(jpeg, std::ios::binary);
  const std::string plain{std::istreambuf_iterator<char>(file), {}};
  const std::string segment = std::string("ICC_PROFILE\0\1\1", 14) + profile;
  std::ofstream(jpeg, std::ios::binary)
      << plain.substr(0, 2) << "\xFF\xE2" << in_bytes(static_cast<std::uint32_t>(segment.size() + 2), 2)
      << segment << plain.substr(2);
}

}  // namespace abbe::test
