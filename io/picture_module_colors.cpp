// Colour properties that a picture file declares.
#include <tiffio.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/picture_codec.h"
#include "io/picture_module.h"
#include "io/picture_module_dng.h"

namespace abbe::picture_module {
namespace {

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

// True if the flags of a WebP declare an ICC profile.
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

}  // namespace

std::string numbers_text(const std::vector<double>& numbers) {
  std::ostringstream text;
  for (const double number : numbers) text << (text.tellp() > 0 ? " " : "") << number;
  return text.str();
}

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

}  // namespace abbe::picture_module
