#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/raw_picture.h"

namespace abbe::picture_module {

// The functions of `PictureCodec` of these names.
std::string encode_dng(const std::string& path, const RawPicture& raw);
std::string encode_fits(const std::string& path, const RawPicture& raw);
RawPicture read_dng(const std::string& path);
RawPicture read_fits(const std::string& path);

/// True if the file has a PNG signature, but is truncated or has a chunk with a wrong checksum [PNG]. False
/// for a file that is not a PNG. OpenImageIO must not read a damaged file: libpng would print to stderr.
bool is_damaged_png(const std::string& path);

/// Colour properties that a picture file declares; "" if it declares none.
struct DeclaredColors {
  /// A value of `kColorSpace`. If Abbe does not support the encoding, a text that names it or says why.
  std::string encoding;
  std::string primaries;  ///< A value of `kPrimariesKey`.
  std::string profile;    ///< A value of `kProfileKey`.
};

/// Colour properties that OpenImageIO reports, apart from the encoding of the codes.
struct LibraryColors {
  std::string_view format;  ///< Name of the format in OpenImageIO.
  bool is_float = false;    ///< True if the file stores floats.
  bool is_grey = false;     ///< True if there are fewer than three channels.
  std::string model = {};   ///< Colour model such as "CMYK" from which the library made RGB, or "".
  int exif_space = 0;       ///< Exif's number of the colour space, or 0.
  std::span<const std::uint8_t> profile = {};  ///< The ICC profile; empty if there is none.
  std::string profile_name = {};               ///< Name of the profile.
};

/// Colour properties of the file at `path`, from `library` and from parts of the file that the library does
/// not report. An unreadable file declares nothing.
DeclaredColors declared_colors(const std::string& path, const LibraryColors& library);

/// The big-endian 32-bit integer at offset `at`; 0 if `bytes` is too short.
std::uint32_t big_endian(std::span<const std::uint8_t> bytes, std::size_t at);

/// Properties in the header of a Radiance picture.
struct RadianceHeader {
  /// Positive factors by which red, green and blue of the stored values were multiplied.
  std::array<double, 3> factors{1, 1, 1};
  std::string primaries;  ///< A value of `kPrimariesKey`; "" if the header has none.
  int orientation = 1;    ///< 1, or a value of `kOrientation`.
};

/// Reads the header of a Radiance picture. OpenImageIO reads its pixels, but does not report all of this, and
/// exchanges two of the orientations [Radiance]. Throws Error{input} if a line lacks its numbers, a factor is
/// not positive, or GAMMA is not 1.
RadianceHeader radiance_header(const std::string& path);

/// Interleaves `planes` planes of equal size that a file stores one after the other.
template <typename T>
std::vector<T> pixel_by_pixel(const std::vector<T>& values, std::size_t planes) {
  const std::size_t pixels = values.size() / planes;
  std::vector<T> by_pixel;
  by_pixel.reserve(values.size());
  for (std::size_t i = 0; i < pixels; ++i)
    for (std::size_t plane = 0; plane < planes; ++plane) by_pixel.push_back(values[plane * pixels + i]);
  return by_pixel;
}

}  // namespace abbe::picture_module
