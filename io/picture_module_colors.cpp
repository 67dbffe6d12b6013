// Properties that a picture file declares and OpenImageIO does not report: colours, ICC profiles, chunks of a
// PNG and the header of a Radiance picture.
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <tiffio.h>
#include <boost/crc.hpp>

#include "io/error.h"
#include "io/picture_codec.h"
#include "io/picture_module.h"
#include "io/picture_module_dng.h"

namespace abbe::picture_module {

namespace {
// The numbers with six significant digits, separated by blanks, as in `kPrimariesKey`.
std::string numbers_text(const std::vector<double>& numbers) {
  std::ostringstream text;
  for (const double number : numbers) text << (text.tellp() > 0 ? " " : "") << number;
  return text.str();
}

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

struct Chunk {
  std::string type;
  std::vector<std::uint8_t> data;
};

/// Reads a file chunk by chunk, if it is a PNG.
class PngFile {
 public:
  explicit PngFile(const std::string& path) : file_(path, std::ios::binary | std::ios::ate) {
    constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
    size_ = static_cast<std::uint64_t>(file_.tellg());
    file_.seekg(0);
    std::string begin(kSignature.size(), '\0');
    is_png_ = file_.read(begin.data(), static_cast<std::streamsize>(begin.size())) && begin == kSignature;
  }
  /// True if the file has a PNG signature.
  [[nodiscard]] bool is_png() const { return is_png_; }

  /// The next chunk. Nothing if it is truncated or its checksum is wrong.
  std::optional<Chunk> next() {
    constexpr std::uint64_t kAround = 12;  // Length, type and checksum [bytes].
    const std::uint64_t left = size_ - static_cast<std::uint64_t>(file_.tellg());
    const std::uint32_t length = left < kAround ? 0 : number();
    if (left < kAround || length > left - kAround) return std::nullopt;
    Chunk chunk{std::string(4, '\0'), std::vector<std::uint8_t>(length)};
    file_.read(chunk.type.data(), 4);
    if (length > 0) file_.read(reinterpret_cast<char*>(chunk.data.data()), length);
    boost::crc_32_type crc;
    crc.process_bytes(chunk.type.data(), chunk.type.size());
    crc.process_bytes(chunk.data.data(), chunk.data.size());
    const bool is_sound = number() == crc.checksum() && file_;
    return is_sound ? std::optional(std::move(chunk)) : std::nullopt;
  }

 private:
  std::uint32_t number() {
    std::array<std::uint8_t, 4> bytes{};
    file_.read(reinterpret_cast<char*>(bytes.data()), 4);
    return big_endian(bytes, 0);
  }

  std::ifstream file_;
  std::uint64_t size_ = 0;
  bool is_png_ = false;
};

// The first chunk of that type before the pixels of a PNG; nothing for other files.
std::optional<std::vector<std::uint8_t>> png_chunk(const std::string& path, std::string_view type) {
  PngFile file(path);
  for (auto chunk = file.next(); chunk && chunk->type != "IDAT"; chunk = file.next())
    if (chunk->type == type) return std::move(chunk->data);
  return std::nullopt;
}

// Colour properties of an ICC profile [ICC], without its name. The tone curve of a grey profile suffices if
// `is_grey`; such a profile has no primaries. The encoding is unsupported if the profile has lookup tables,
// or not one curve, a power or that of sRGB, for all channels, or no primaries.
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

// Values of `kColorSpace` for codes that cannot be decoded:
// - kUnread: the library does not return the profile (of a WebP, or a damaged or unsuitable profile),
// - kUnreadHeif: the library returns no colour properties of HEIF files,
// - kEncodedFloats: the profile of a float image has tone curves,
// - kUncalibrated: Exif declares it.
constexpr const char* kUnread = "an ICC profile that cannot be read";
constexpr const char* kUnreadHeif = "HEIF colours, which are not supported";
constexpr const char* kEncodedFloats = "floats with a non-linear ICC profile";
constexpr const char* kUncalibrated = "uncalibrated";

// Colour properties of the ICC profile; nothing without one.
std::optional<DeclaredColors> profile_colors(const LibraryColors& library) {
  if (library.profile.empty()) return std::nullopt;
  DeclaredColors colors = icc_colors(library.profile, library.is_grey);
  if (library.is_float && colors.encoding != kLinear) colors.encoding = kEncodedFloats;
  colors.profile = library.profile_name.empty() ? "without a name" : library.profile_name;
  return colors;
}

// Primaries as in `kPrimariesKey`, from the chunk cHRM: x and y of white, red, green and blue in units of
// 1e-5 [PNG, sec. 11.3.3.1]. "" if the chunk is missing or has impossible values, which libpng ignores as
// well.
std::string png_primaries(const std::string& path) {
  constexpr std::size_t kBytes = 32;
  constexpr double kRounding = 1e-4;
  const auto chunk = png_chunk(path, "cHRM");
  if (!chunk || chunk->size() != kBytes) return "";
  std::vector<double> xy;
  for (const std::size_t i : {2U, 3U, 4U, 5U, 6U, 7U, 0U, 1U}) xy.push_back(big_endian(*chunk, 4 * i) / 1e5);
  for (std::size_t i = 0; i < xy.size(); i += 2)
    if (xy[i] + xy[i + 1] > 1 + kRounding) return "";
  return xy.back() > 0 ? numbers_text(xy) : "";
}

// True if the gamma is the one that [PNG, sec. 11.3.3.5] prescribes next to the chunk sRGB. Many programs
// write it alone and mean sRGB.
bool has_gamma_of_srgb(const std::string& path) {
  constexpr std::uint32_t kSrgbGamma = 45455;
  const auto chunk = png_chunk(path, "gAMA");
  return chunk && big_endian(*chunk, 0) == kSrgbGamma;
}

// Colour properties of a PNG by the chunks of its third edition [PNG]: cICP, then a profile, then sRGB, then
// gAMA and cHRM. libpng ignores a profile after an sRGB chunk, and a colour profile in a grey picture;
// nothing is declared then.
DeclaredColors png_colors(const std::string& path, const LibraryColors& library) {
  if (const auto points = png_chunk(path, "cICP")) {
    const std::vector<std::uint8_t> srgb{1, 13, 0, 1};
    return {*points == srgb ? "sRGB" : "cICP " + numbers_text({points->begin(), points->end()}), "", ""};
  }
  if (auto colors = profile_colors(library)) return *std::move(colors);
  if (png_chunk(path, "sRGB")) return {"sRGB", "", ""};
  if (!library.is_grey && png_chunk(path, "iCCP")) return {kUnread, "", ""};
  return {has_gamma_of_srgb(path) ? "sRGB" : "", png_primaries(path), ""};
}

// Copies the numbers of a tag, unless it is absent or all are 0, which some writers use for unknown values.
void take_numbers(TIFF* tiff, std::uint32_t tag, std::span<double> numbers) {
  const float* stored = nullptr;
  if (TIFFGetField(tiff, tag, &stored) != 1) return;
  const std::span<const float> values(stored, numbers.size());
  if (std::ranges::any_of(values, [](float value) { return value != 0; }))
    std::ranges::copy(values, numbers.begin());
}

// Colour properties of a TIFF by its tags for primaries and white. If one of them is missing, that of Rec.709
// replaces it.
DeclaredColors tiff_colors(const std::string& path) {
  const Tiff tiff(TIFFOpenExt(path.c_str(), "r", quiet_tiff().get()), TIFFClose);
  std::vector<double> xy{0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329};
  const std::vector<double> rec709 = xy;
  if (!tiff) return {};
  take_numbers(tiff.get(), TIFFTAG_PRIMARYCHROMATICITIES, std::span(xy).first(6));
  take_numbers(tiff.get(), TIFFTAG_WHITEPOINT, std::span(xy).last(2));
  return {"", xy == rec709 ? "" : numbers_text(xy), ""};
}

bool has_webp_profile(const std::string& path) {
  constexpr unsigned kProfile = 0x20;
  std::ifstream file(path, std::ios::binary);
  std::string head(21, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  return head.substr(12, 4) == "VP8X" && (static_cast<unsigned char>(head.back()) & kProfile) != 0;
}

// True if a JPEG segment before the pixels contains an ICC profile or a part of one [ICC, annex B].
bool has_jpeg_profile(const std::string& path) {
  constexpr std::string_view kName("ICC_PROFILE\0", 12);
  constexpr int kMarker = 0xFF;
  constexpr int kScan = 0xDA;
  constexpr int kApplication2 = 0xE2;
  std::ifstream file(path, std::ios::binary);
  file.seekg(2);
  while (file.get() == kMarker) {
    while (file.peek() == kMarker) file.get();  // Fill bytes between segments.
    const int type = file.get();
    std::array<std::uint8_t, 4> size{};
    file.read(reinterpret_cast<char*>(size.data() + 2), 2);
    if (!file || type == kScan) return false;
    const std::streamoff data = file.tellg();
    std::string name(kName.size(), '\0');
    file.read(name.data(), static_cast<std::streamsize>(name.size()));
    if (type == kApplication2 && name == kName) return true;
    file.seekg(data + static_cast<std::streamoff>(big_endian(size, 0)) - 2);
  }
  return false;
}

// Encoding that Exif's number of the colour space declares; "" for sRGB and if absent [Exif, sec. 4.6.5].
std::string exif_encoding(int space) {
  constexpr int kSrgb = 1;
  constexpr int kExifUncalibrated = 65535;
  if (space == 0 || space == kSrgb) return "";
  return space == kExifUncalibrated ? kUncalibrated : "number " + std::to_string(space) + " of Exif";
}

// The numbers after "KEY=" in a line; throws unless there are `count`.
std::vector<double> numbers_of(const std::string& line, std::size_t count, const std::string& path) {
  std::istringstream words(line.substr(line.find('=') + 1));
  std::vector<double> numbers;
  for (double number = 0; words >> number;) numbers.push_back(number);
  if (!words.eof() || numbers.size() != count)
    throw Error(ErrorCode::input, path,
                "wrong count of numbers (got \"" + line + "\", allowed " + std::to_string(count) + ")");
  return numbers;
}

// Multiplies `factors` by the numbers of a line: one for all channels or one for each.
void take_factors(const std::string& line, std::size_t count, const std::string& path,
                  std::array<double, 3>& factors) {
  const std::vector<double> values = numbers_of(line, count, path);
  if (std::ranges::any_of(values, [](double factor) { return !(factor > 0); }))
    throw Error(ErrorCode::input, path,
                "factors of the pixels must be positive (got \"" + line + "\", allowed > 0)");
  for (std::size_t c = 0; c < 3; ++c) factors.at(c) *= values[c % count];
}

// Primaries of a line; "" for zeros, which some programs write for unknown primaries.
std::string primaries_of(const std::string& line, const std::string& path) {
  const std::vector<double> values = numbers_of(line, 8, path);
  if (std::ranges::all_of(values, [](double number) { return number == 0; })) return "";
  return numbers_text(values);
}

void read_line(const std::string& line, const std::string& path, RadianceHeader& header) {
  if (line.starts_with("EXPOSURE=")) take_factors(line, 1, path, header.factors);
  if (line.starts_with("COLORCORR=")) take_factors(line, 3, path, header.factors);
  if (line.starts_with("PRIMARIES=")) header.primaries = primaries_of(line, path);
  if (line.starts_with("GAMMA=") && numbers_of(line, 1, path).front() != 1)
    throw Error(ErrorCode::input, path, "values are not linear (got \"" + line + "\", allowed GAMMA=1)");
}

// Orientation from the line "-Y 600 +X 800". The first axis runs across rows, the second along them. +X
// points to the right, +Y upwards.
int orientation_of(const std::string& line) {
  const bool from_right = line.find("-X") != std::string::npos;
  const bool from_bottom = line.find("+Y") != std::string::npos;
  const bool rows_are_columns = line.find('X') < line.find('Y');
  const int quarter = from_bottom ? (from_right ? 2 : 3) : (from_right ? 1 : 0);
  return 1 + quarter + (rows_are_columns ? 4 : 0);
}

}  // namespace

DeclaredColors declared_colors(const std::string& path, const LibraryColors& library) {
  constexpr std::array<std::string_view, 4> kRgbModels{"", "RGB", "YCbCr", "palette"};
  if (std::ranges::find(kRgbModels, library.model) == kRgbModels.end()) return {library.model, "", ""};
  if (library.format == "png") return png_colors(path, library);
  if (auto colors = profile_colors(library)) return *std::move(colors);
  if (library.format == "heif") return {kUnreadHeif, "", ""};
  if (library.format == "webp" && has_webp_profile(path)) return {kUnread, "", ""};
  if (library.format == "jpeg" && has_jpeg_profile(path)) return {kUnread, "", ""};
  if (auto space = exif_encoding(library.exif_space); !space.empty()) return {std::move(space), "", ""};
  return library.format == "tiff" ? tiff_colors(path) : DeclaredColors{};
}

std::uint32_t big_endian(std::span<const std::uint8_t> bytes, std::size_t at) {
  if (bytes.size() < 4 || at > bytes.size() - 4) return 0;
  std::uint32_t number = 0;
  for (const std::uint8_t byte : bytes.subspan(at, 4)) number = number << 8U | byte;
  return number;
}

bool is_damaged_png(const std::string& path) {
  PngFile file(path);
  if (!file.is_png()) return false;
  for (auto chunk = file.next(); chunk; chunk = file.next())
    if (chunk->type == "IEND") return false;
  return true;
}

RadianceHeader radiance_header(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  RadianceHeader header;
  std::string line;
  while (std::getline(file, line) && !line.empty()) read_line(line, path, header);
  std::getline(file, line);
  header.orientation = orientation_of(line);
  return header;
}

}  // namespace abbe::picture_module
