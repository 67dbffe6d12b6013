#pragma once

#include <string>

#include "io/picture_codec.h"

namespace abbe {

/// The bytes of a PNG of one channel, as grey, or three: rows from the top, with the metadata as texts. Codes
/// are tagged by the attribute `kColorSpace`, as "sRGB", or with the gamma of "Linear" or "Gamma" and a
/// number and with the primaries of `kPrimariesKey`; by another word they are not. `path` names the file in
/// errors: throws Error{output}.
[[nodiscard]] std::string encode_png(const std::string& path, const PictureHeader& header,
                                     const PictureCodes& codes);

}  // namespace abbe
