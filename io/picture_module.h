#pragma once

#include <array>
#include <cstdint>
#include <string>
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
