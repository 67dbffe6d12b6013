#pragma once

#include <string>

#include "io/picture_codec.h"

namespace abbe {

/// The bytes of a PNG of one channel, as grey, or three: rows from the top, with the metadata as texts. The
/// attribute `kColorSpace` says whether codes are tagged as "sRGB" or as "Linear". `path` names the file
/// in errors: throws Error{output}.
[[nodiscard]] std::string encode_png(const std::string& path, const PictureHeader& header,
                                     const PictureCodes& codes);

}  // namespace abbe
