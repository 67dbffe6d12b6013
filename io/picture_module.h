#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/raw_picture.h"

namespace abbe::picture_module {

/// The bytes of a DNG, by libtiff, checked to read back. Throws Error{output}.
std::string encode_dng(const std::string& path, const RawPicture& raw);

/// The bytes of a FITS file, by cfitsio, checked to read back. Throws Error{output}.
std::string encode_fits(const std::string& path, const RawPicture& raw);

/// Whether a file that begins as a PNG is cut short, or one of its chunks contradicts its checksum [PNG].
/// Such a file is not for OpenImageIO, behind which libpng tells of it on stderr and cannot be kept from it.
bool is_damaged_png(const std::string& path);

/// The data of the first chunk of that type before the pixels of a PNG; nothing where there is none.
std::optional<std::vector<std::uint8_t>> png_chunk(const std::string& path, std::string_view type);

/// What a file says of its colours; "" where it says nothing.
struct ColorsTold {
  std::string encoding;   ///< As `kColorSpace` has it, or a text that is no encoding where it is another.
  std::string primaries;  ///< As `kPrimariesKey` has them.
  std::string profile;    ///< As `kProfileKey` has it.
};

/// What OpenImageIO tells of a file's colours beside how its codes are encoded.
struct LibraryColors {
  std::string_view format;                     ///< The kind of file, by the library's name.
  bool is_float = false;                       ///< Whether values are floats.
  bool is_grey = false;                        ///< Whether there are fewer planes than red, green and blue.
  std::string model = {};                      ///< As "CMYK", of which red, green and blue were made, or "".
  int exif_space = 0;                          ///< The number that Exif has for the colour space, or 0.
  std::span<const std::uint8_t> profile = {};  ///< The bytes of the ICC profile; none without one.
  std::string profile_name = {};               ///< What the profile calls itself.
};

/// What the file at `path` says of its colours, by the library and by what that leaves out.
ColorsTold colors_told(const std::string& path, const LibraryColors& library);

/// What the bytes of an ICC profile say of a picture, which may be of grey alone and then needs no primaries
/// [ICC]: all but the profile's name. Its encoding is none, a text that says why, where the profile has
/// tables of colours or no tone curves and primaries, where its channels differ in them, or where they are
/// neither powers nor those of sRGB.
ColorsTold icc_colors(std::span<const std::uint8_t> profile, bool is_grey);

/// The number of 4 bytes from `at` on, the most significant first; 0 where they are not all there.
std::uint32_t big_endian(std::span<const std::uint8_t> bytes, std::size_t at);

/// Numbers with blanks between them, as `kPrimariesKey` has them.
std::string numbers_text(const std::vector<double>& numbers);

/// What the lines at the head of a Radiance picture say of its pixels.
struct RadianceHeader {
  std::array<double, 3> factors{1, 1, 1};  ///< By which red, green and blue were multiplied.
  std::string primaries;                   ///< As `kPrimariesKey` has them; "" where none are told.
  int orientation = 1;                     ///< As `kOrientation` counts.
};

/// Reads them from a picture that OpenImageIO reads, which does not tell of all, and exchanges two of the
/// orientations [Radiance]. Throws Error{input} for lines without the numbers that they should have, and for
/// a GAMMA other than 1.
RadianceHeader radiance_header(const std::string& path);

/// The codes of so many planes, pixel by pixel, of which a file has one plane after the other.
std::vector<std::uint16_t> pixel_by_pixel(const std::vector<std::uint16_t>& codes, std::size_t planes);

/// What such files hold. Throw Error{input} and Error{resource}.
RawPicture read_dng(const std::string& path);
RawPicture read_fits(const std::string& path);

}  // namespace abbe::picture_module
