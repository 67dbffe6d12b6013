// What a picture's file says of the colours that its codes stand for.
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

// What `kColorSpace` is where nothing can be said of codes: of a file with a profile that the library leaves
// out, as it does of a WebP and where it is damaged, cut short or of another kind of image, of a HEIF, of
// which it leaves out all, of floats whose profile has tone curves, and of codes that Exif calls so.
constexpr const char* kUnread = "a profile that is not read";
constexpr const char* kUnreadHeif = "that of a HEIF, which is not read";
constexpr const char* kEncodedFloats = "floats that are not linear by their profile";
constexpr const char* kUncalibrated = "uncalibrated";

// By its profile; nothing without one.
std::optional<ColorsTold> of_profile(const LibraryColors& library) {
  if (library.profile.empty()) return std::nullopt;
  ColorsTold told = icc_colors(library.profile, library.is_grey);
  if (library.is_float && told.encoding != kLinear) told.encoding = kEncodedFloats;
  told.profile = library.profile_name.empty() ? "without a name" : library.profile_name;
  return told;
}

// The primaries as `kPrimariesKey` has them; "" where the file tells none, or what cannot be any, which all
// who read by libpng leave out. The chunk is of white, red, green and blue, each x and y in 100000ths [PNG,
// sec. 11.3.3.1].
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

// Whether the gamma is the one that [PNG, sec. 11.3.3.5] prescribes beside sRGB, for those who do not know
// that: many programs write it alone for sRGB.
bool has_gamma_of_srgb(const std::string& path) {
  constexpr std::uint32_t kOfSrgb = 45455;
  const auto chunk = png_chunk(path, "gAMA");
  return chunk && big_endian(*chunk, 0) == kOfSrgb;
}

// By the chunks of the third edition of [PNG], of which the first counts that there is and that libpng takes:
// it leaves out a profile beside an `sRGB` before it, and one of colours in a picture of grey, of which
// nothing is told then.
ColorsTold of_png(const std::string& path, const LibraryColors& library) {
  if (const auto points = png_chunk(path, "cICP")) {
    const std::vector<std::uint8_t> srgb{1, 13, 0, 1};
    return {*points == srgb ? "sRGB" : "cICP " + numbers_text({points->begin(), points->end()}), "", ""};
  }
  if (auto told = of_profile(library)) return *std::move(told);
  if (png_chunk(path, "sRGB")) return {"sRGB", "", ""};
  if (!library.is_grey && png_chunk(path, "iCCP")) return {kUnread, "", ""};
  return {has_gamma_of_srgb(path) ? "sRGB" : "", png_primaries(path), ""};
}

// The numbers of a tag, unless they are absent or all 0, as of writers that know none.
void take_numbers(TIFF* tiff, std::uint32_t tag, std::span<double> numbers) {
  const float* told = nullptr;
  if (TIFFGetField(tiff, tag, &told) != 1) return;
  const std::span<const float> values(told, numbers.size());
  if (std::ranges::any_of(values, [](float value) { return value != 0; }))
    std::ranges::copy(values, numbers.begin());
}

// By the tags of its primaries and its white, of which it may have one alone: the other counts as that of
// Rec.709.
ColorsTold of_tiff(const std::string& path) {
  const Tiff tiff(TIFFOpenExt(path.c_str(), "r", quiet_tiff().get()), TIFFClose);
  std::vector<double> xy{0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329};
  const std::vector<double> rec709 = xy;
  if (!tiff) return {};
  take_numbers(tiff.get(), TIFFTAG_PRIMARYCHROMATICITIES, std::span(xy).first(6));
  take_numbers(tiff.get(), TIFFTAG_WHITEPOINT, std::span(xy).last(2));
  return {"", xy == rec709 ? "" : numbers_text(xy), ""};
}

// Whether the flags of a WebP announce a profile.
bool has_webp_profile(const std::string& path) {
  constexpr unsigned kProfile = 0x20;
  std::ifstream file(path, std::ios::binary);
  std::string head(21, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  return head.substr(12, 4) == "VP8X" && (static_cast<unsigned char>(head.back()) & kProfile) != 0;
}

// Whether a segment of a JPEG before its pixels holds a profile or a part of one [ICC, annex B].
bool has_jpeg_profile(const std::string& path) {
  constexpr std::string_view kName("ICC_PROFILE\0", 12);
  constexpr int kMarker = 0xFF;
  constexpr int kScan = 0xDA;
  constexpr int kApplication2 = 0xE2;
  std::ifstream file(path, std::ios::binary);
  file.seekg(2);
  while (file.get() == kMarker) {
    while (file.peek() == kMarker) file.get();  // which may fill the room between segments
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

// What Exif's number for the colour space says; "" for sRGB and where it says nothing [Exif, sec. 4.6.5].
std::string of_exif(int space) {
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

ColorsTold colors_told(const std::string& path, const LibraryColors& library) {
  constexpr std::array<std::string_view, 4> kOfRgb{"", "RGB", "YCbCr", "palette"};
  if (std::ranges::find(kOfRgb, library.model) == kOfRgb.end()) return {library.model, "", ""};
  if (library.format == "png") return of_png(path, library);
  if (auto told = of_profile(library)) return *std::move(told);
  if (library.format == "heif") return {kUnreadHeif, "", ""};
  if (library.format == "webp" && has_webp_profile(path)) return {kUnread, "", ""};
  if (library.format == "jpeg" && has_jpeg_profile(path)) return {kUnread, "", ""};
  if (auto told = of_exif(library.exif_space); !told.empty()) return {std::move(told), "", ""};
  return library.format == "tiff" ? of_tiff(path) : ColorsTold{};
}

}  // namespace abbe::picture_module
