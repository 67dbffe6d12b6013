#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "io/raw_picture.h"

namespace abbe {

/// What a picture file says of itself beside its pixels.
struct PictureHeader {
  std::int64_t width = 0;
  std::int64_t height = 0;
  std::vector<std::string> channels;  ///< Their names, in the order of a pixel's values.
  /// Attributes that are texts, by OpenImageIO's names, `kOrientation`, `kPrimariesKey` and `kProfileKey`.
  std::map<std::string, std::string> metadata;
};

/// The attribute that says how a picture's codes are to be read: "sRGB", "Linear", or "Gamma" before the
/// power of a code in [0, 1] that is linear; any other text says that they are encoded otherwise.
inline constexpr const char* kColorSpace = "oiio:ColorSpace";
inline constexpr const char* kLinear = "Linear";
inline constexpr const char* kGamma = "Gamma";

/// The attribute with the name of the ICC profile that a picture's file holds, by which its `kColorSpace` and
/// `kPrimariesKey` are then.
inline constexpr const char* kProfileKey = "icc_profile";

/// The values of a picture to be written, pixel by pixel, as 8-bit or 16-bit codes.
using PictureCodes = std::variant<std::vector<std::uint8_t>, std::vector<std::uint16_t>>;

/// What the module of pictures offers: OpenImageIO, libtiff and cfitsio, of which the first brings some 250
/// shared libraries and with them a fifth of a second at every start, is loaded with it when a picture is
/// first read, or written as anything but a PNG. The module holds no state of the program's rooms: all it
/// needs is in the arguments, and it reports failures as `Error`.
struct PictureCodec {
  /// The bytes of a file of the format that the extension of `path` names, checked to read back. Throws
  /// Error{output}.
  std::string (*encode)(const std::string& path, const PictureHeader& header, const PictureCodes& codes);

  /// Reads the file into the place that `room` gives for its header: width * height * channels floats, pixel
  /// by pixel, scaled to [0, 1] for integer files. What a file holds beside an alpha channel is as stored,
  /// and the factors are taken off that a Radiance file says it was multiplied by. `room` may throw. Throws
  /// Error{input}.
  void (*read)(const std::string& path, const std::function<float*(const PictureHeader&)>& room);

  /// The bytes of a DNG (libtiff) and of a FITS file (cfitsio), checked to read back. Throw Error{output}.
  std::string (*encode_dng)(const std::string& path, const RawPicture& raw);
  std::string (*encode_fits)(const std::string& path, const RawPicture& raw);
  /// Read one. Throw Error{input} and Error{resource}.
  RawPicture (*read_dng)(const std::string& path);
  RawPicture (*read_fits)(const std::string& path);
};

/// The name under which the module exports a function that returns a `const PictureCodec*`.
inline constexpr const char* kPictureCodecSymbol = "abbe_picture_codec";

/// The module's functions. The first call opens the module, found along the program's run path (RUNPATH, or
/// LD_LIBRARY_PATH); throws Error{input} when it is not there or does not load.
[[nodiscard]] const PictureCodec& picture_codec();

}  // namespace abbe
