#pragma once

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

/// The codes of so many planes, pixel by pixel, of which a file has one plane after the other.
std::vector<std::uint16_t> pixel_by_pixel(const std::vector<std::uint16_t>& codes, std::size_t planes);

/// What such files hold. Throw Error{input} and Error{resource}.
RawPicture read_dng(const std::string& path);
RawPicture read_fits(const std::string& path);

}  // namespace abbe::picture_module
