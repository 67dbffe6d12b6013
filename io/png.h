#pragma once

#include <string>

#include "io/picture_codec.h"

namespace abbe {

/// The bytes of a PNG file with one channel, as grey, or three, with rows from the top and the metadata as
/// text chunks. `kColorSpace` decides the colour chunks: "sRGB", or a gamma and `kPrimariesKey` for "Linear"
/// and "Gamma" with an exponent; other values write none. `path` names the file in errors. Throws
/// Error{output}.
[[nodiscard]] std::string encode_png(const std::string& path, const PictureHeader& header,
                                     const PictureCodes& codes);

}  // namespace abbe
