// What a picture's file says of the colours that its codes stand for.
#include <tiffio.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <optional>
#include <sstream>
#include <vector>

#include "io/picture_codec.h"
#include "io/picture_module.h"
#include "io/picture_module_dng.h"

namespace abbe::picture_module {
namespace {

// What `kColorSpace` is where nothing can be said of codes: of a file with a profile that the library leaves
// out, as it does of a WebP and where it is damaged or of another kind of image, of a HEIF, of which it
// leaves out all, of floats whose profile has tone curves, and of codes that Exif calls so.
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

// Of white, red, green and blue, each x and y in 100000ths [PNG, sec. 11.3.3.1].
std::string png_primaries(const std::vector<std::uint8_t>& chunk) {
  std::vector<double> xy;
  for (const std::size_t i : {2U, 3U, 4U, 5U, 6U, 7U, 0U, 1U}) xy.push_back(big_endian(chunk, 4 * i) / 1e5);
  return numbers_text(xy);
}

// By the chunks of the third edition of [PNG], of which the first counts that there is.
ColorsTold of_png(const std::string& path, const LibraryColors& library) {
  if (const auto points = png_chunk(path, "cICP")) {
    const std::vector<std::uint8_t> srgb{1, 13, 0, 1};
    return {*points == srgb ? "sRGB" : "cICP " + numbers_text({points->begin(), points->end()}), "", ""};
  }
  if (auto told = of_profile(library)) return *std::move(told);
  if (png_chunk(path, "iCCP")) return {kUnread, "", ""};
  const auto primaries = png_chunk(path, "cHRM");
  if (!primaries || png_chunk(path, "sRGB")) return {};
  return {"", png_primaries(*primaries), ""};
}

// By the tags of its primaries and its white, of which it may have one alone: the other counts as that of
// Rec.709.
ColorsTold of_tiff(const std::string& path) {
  const Tiff tiff(TIFFOpenExt(path.c_str(), "r", quiet_tiff().get()), TIFFClose);
  const float* told = nullptr;
  std::vector<double> xy{0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329};
  const std::vector<double> rec709 = xy;
  if (tiff && TIFFGetField(tiff.get(), TIFFTAG_PRIMARYCHROMATICITIES, &told) == 1)
    std::copy_n(told, 6, xy.begin());
  if (tiff && TIFFGetField(tiff.get(), TIFFTAG_WHITEPOINT, &told) == 1) std::copy_n(told, 2, xy.begin() + 6);
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

}  // namespace

std::string numbers_text(const std::vector<double>& numbers) {
  std::ostringstream text;
  for (const double number : numbers) text << (text.tellp() > 0 ? " " : "") << number;
  return text.str();
}

ColorsTold colors_told(const std::string& path, const LibraryColors& library) {
  constexpr std::array<std::string_view, 4> kOfRgb{"", "RGB", "YCbCr", "palette"};
  constexpr int kExifUncalibrated = 65535;  // [Exif, sec. 4.6.5]
  if (std::ranges::find(kOfRgb, library.model) == kOfRgb.end()) return {library.model, "", ""};
  if (library.format == "png") return of_png(path, library);
  if (auto told = of_profile(library)) return *std::move(told);
  if (library.format == "heif") return {kUnreadHeif, "", ""};
  if (library.format == "webp" && has_webp_profile(path)) return {kUnread, "", ""};
  if (library.exif_space == kExifUncalibrated) return {kUncalibrated, "", ""};
  return library.format == "tiff" ? of_tiff(path) : ColorsTold{};
}

}  // namespace abbe::picture_module
