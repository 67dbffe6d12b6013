#pragma once

#include <string>

#include "io/raw_picture.h"

namespace abbe::picture_module {

/// The bytes of a DNG, by libtiff, checked to read back. Throws Error{output}.
std::string encode_dng(const std::string& path, const RawPicture& raw);

/// The bytes of a FITS file, by cfitsio, checked to read back. Throws Error{output}.
std::string encode_fits(const std::string& path, const RawPicture& raw);

/// What such files hold. Throw Error{input} and Error{resource}.
RawPicture read_dng(const std::string& path);
RawPicture read_fits(const std::string& path);

}  // namespace abbe::picture_module
