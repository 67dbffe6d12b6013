#pragma once

#include <string>

#include "io/picture_codec.h"

namespace abbe {

/// The bytes of a PNG file with one channel, as grey, or three, as red, green and blue, with 8 or 16 bits as
/// `codes` has. The metadata become text chunks. `kColorSpace` decides the colour chunks:
/// - "sRGB" writes that of sRGB;
/// - "Linear", and "Gamma" with an exponent, write a gamma and `kPrimariesKey`;
/// - other values write none.
/// `path` names the file in errors; it is not written. Throws Error{output} if libpng fails.
[[nodiscard]] std::string encode_png(const std::string& path, const PictureHeader& header,
                                     const PictureCodes& codes);

}  // namespace abbe
