// Colour properties of an ICC profile: three tone curves and the primaries, or the tone curve of grey [ICC].
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>
#include <string_view>
#include <vector>

#include "io/picture_codec.h"
#include "io/picture_module.h"

namespace abbe::picture_module {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr double kNoCurve = std::numeric_limits<double>::quiet_NaN();
// Values of `kColorSpace` for profiles that are not one curve and three primaries.
constexpr const char* kOtherCurves = "unsupported tone curves or primaries";
constexpr const char* kTables = "colour lookup tables or L*a*b*";

bool has_word(Bytes bytes, std::size_t at, std::string_view word) {
  return bytes.size() >= at + word.size() &&
         std::equal(word.begin(), word.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at));
}

// A signed fixed-point number with 16 fractional bits.
double fixed(Bytes bytes, std::size_t at) {
  return static_cast<std::int32_t>(big_endian(bytes, at)) / 65536.0;
}

// The bytes of a tag; empty if it is missing or exceeds the profile.
Bytes tag(Bytes profile, std::string_view name) {
  constexpr std::size_t kCount = 128;
  constexpr std::size_t kEntry = 12;
  const std::size_t max_count = profile.size() / kEntry;
  const std::size_t count = std::min<std::size_t>(big_endian(profile, kCount), max_count);
  for (std::size_t at = kCount + 4; at < kCount + 4 + count * kEntry; at += kEntry) {
    if (!has_word(profile, at, name)) continue;
    const std::size_t from = big_endian(profile, at + 4);
    const std::size_t size = big_endian(profile, at + 8);
    return from > profile.size() || size > profile.size() - from ? Bytes() : profile.subspan(from, size);
  }
  return {};
}

// Value of a `curv` curve: the identity for no entries, a power for one entry, otherwise a table.
double by_table(Bytes curve, double code) {
  constexpr std::size_t kFirst = 12;
  const std::size_t count = big_endian(curve, 8);
  if (curve.size() < kFirst || count > (curve.size() - kFirst) / 2) return kNoCurve;
  const auto number = [&](std::size_t i) {
    return 256.0 * curve[kFirst + 2 * i] + curve[kFirst + 2 * i + 1];
  };
  if (count == 0) return code;
  if (count == 1) return std::pow(code, number(0) / 256);
  const double at = code * static_cast<double>(count - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(at), count - 2);
  return std::lerp(number(i), number(i + 1), at - static_cast<double>(i)) / 65535;
}

// Value of a `para` curve: (a x + b)^g + e for x >= d, otherwise c x + f.
double by_parameters(Bytes curve, double code) {
  constexpr std::array<std::size_t, 5> kCounts{1, 3, 4, 5, 7};
  const std::size_t type = big_endian(curve, 8) >> 16U;
  if (type >= kCounts.size() || curve.size() < 12 + 4 * kCounts.at(type)) return kNoCurve;
  const auto p = [&](std::size_t i) { return fixed(curve, 12 + 4 * i); };
  if (type == 0) return std::pow(code, p(0));
  const double from = type < 3 ? -p(2) / p(1) : p(4);
  const double c = type < 3 ? 0 : p(3);
  const double e = type == 2 ? p(3) : type == 4 ? p(5) : 0;
  const double f = type == 2 ? p(3) : type == 4 ? p(6) : 0;
  return code < from ? c * code + f : std::pow(p(1) * code + p(2), p(0)) + e;
}

// Linear value of a code in [0, 1]; NaN if the curve is invalid.
double decoded(Bytes curve, double code) {
  if (has_word(curve, 0, "curv")) return by_table(curve, code);
  return has_word(curve, 0, "para") ? by_parameters(curve, code) : kNoCurve;
}

// [IEC61966, sec. 5.2]
double srgb(double code) {
  return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

// True if the tone curve agrees with `linear` on [0, 1] within `tolerance`.
template <typename Linear>
bool is_near(Bytes curve, double tolerance, Linear linear) {
  constexpr int kSteps = 32;
  for (int i = 0; i <= kSteps; ++i) {
    const double code = static_cast<double>(i) / kSteps;
    if (!(std::abs(decoded(curve, code) - linear(code)) <= tolerance)) return false;
  }
  return true;
}

// The curve as a value of `kColorSpace`. Small profiles have short tables of the sRGB curve, with
// interpolation errors of a few thousandths. sRGB differs from a power of 2.2 by up to 0.008.
std::string curve_encoding(Bytes curve) {
  constexpr double kPower = 1e-3;
  constexpr double kSmallTable = 5e-3;
  const double gamma = std::log(decoded(curve, 0.5)) / std::log(0.5);
  if (is_near(curve, kPower, [gamma](double code) { return std::pow(code, gamma); })) {
    std::ostringstream text;
    text << kGamma << gamma;
    return std::abs(gamma - 1) < kPower ? kLinear : text.str();
  }
  return is_near(curve, kSmallTable, srgb) ? "sRGB" : kOtherCurves;
}

// Chromaticities of the primaries and of D50, to which profiles refer; "" if primaries are missing.
std::string profile_primaries(Bytes profile) {
  std::vector<double> xy;
  for (const char* const name : {"rXYZ", "gXYZ", "bXYZ"}) {
    const Bytes xyz = tag(profile, name);
    if (xyz.size() < 20 || !has_word(xyz, 0, "XYZ ")) return "";
    const double sum = fixed(xyz, 8) + fixed(xyz, 12) + fixed(xyz, 16);
    for (const std::size_t at : {8U, 12U}) xy.push_back(fixed(xyz, at) / sum);
  }
  xy.insert(xy.end(), {0.3457, 0.3585});
  return numbers_text(xy);
}

}  // namespace

std::uint32_t big_endian(std::span<const std::uint8_t> bytes, std::size_t at) {
  if (bytes.size() < 4 || at > bytes.size() - 4) return 0;
  std::uint32_t number = 0;
  for (const std::uint8_t byte : bytes.subspan(at, 4)) number = number << 8U | byte;
  return number;
}

DeclaredColors icc_colors(std::span<const std::uint8_t> profile, bool is_grey) {
  constexpr std::size_t kConnectionSpace = 20;
  const bool has_table = !has_word(profile, kConnectionSpace, "XYZ ") || !tag(profile, "A2B0").empty();
  const bool has_grey = is_grey && !tag(profile, "kTRC").empty();
  const std::vector<const char*> names = has_grey ? std::vector{"kTRC"} : std::vector{"rTRC", "gTRC", "bTRC"};
  std::set<std::string> encodings;
  for (const char* const name : names) encodings.insert(curve_encoding(tag(profile, name)));
  DeclaredColors colors{*encodings.begin(), profile_primaries(profile), ""};
  if (encodings.size() > 1 || (!is_grey && colors.primaries.empty())) colors.encoding = kOtherCurves;
  if (has_table) colors.encoding = kTables;
  return colors;
}

}  // namespace abbe::picture_module
