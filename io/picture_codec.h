#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "io/raw_picture.h"

namespace abbe {

/// Size, channel names and attributes of a picture file.
struct PictureHeader {
  std::int64_t width = 0;
  std::int64_t height = 0;
  std::vector<std::string> channels;  ///< Names, in the order of the values of a pixel.
  /// Text attributes under OpenImageIO's names, and `kOrientation`, `kPrimariesKey`, `kColorSpace` and
  /// `kProfileKey`. A key is absent if the file declares nothing.
  std::map<std::string, std::string> metadata;
};

/// Metadata key for the encoding of a picture's codes: "sRGB", "Linear", or "Gamma" followed by the exponent
/// p, such as "Gamma2.2". Then the linear value is code^p for codes in [0, 1]. Any other text names an
/// encoding that Abbe does not decode.
inline constexpr const char* kColorSpace = "oiio:ColorSpace";
inline constexpr const char* kLinear = "Linear";
inline constexpr const char* kGamma = "Gamma";

/// Metadata key for the name of the ICC profile in the file. If present, `kColorSpace` and `kPrimariesKey`
/// come from that profile.
inline constexpr const char* kProfileKey = "icc_profile";

/// Values of a picture to be written as 8-bit or 16-bit codes, row by row from the top left, with the
/// channels of a pixel together. There are width * height * channels of them.
using PictureCodes = std::variant<std::vector<std::uint8_t>, std::vector<std::uint16_t>>;

/// Function table of the picture module, which uses OpenImageIO, libtiff and cfitsio. OpenImageIO loads some
/// 250 shared libraries, which takes a fifth of a second, so the module is opened at the first use. It shares
/// no state with the program: it works on its arguments and throws `Error`.
struct PictureCodec {
  /// The bytes of a file in the format that the extension of `path` names, checked by reading their size
  /// back. The file is not written. Throws Error{output}, also for an unknown extension.
  std::string (*encode)(const std::string& path, const PictureHeader& header, const PictureCodes& codes);

  /// Reads the file `path` as `read_picture` describes. `allocate` is called once with its header and returns
  /// the destination: width * height * channels floats, pixel by pixel. It may throw.
  void (*read)(const std::string& path, const std::function<float*(const PictureHeader&)>& allocate);

  /// The bytes of a DNG file (libtiff) and of a FITS file (cfitsio), checked by reading them back. They throw
  /// Error{output}, which names the file `path`; it is not written.
  std::string (*encode_dng)(const std::string& path, const RawPicture& raw);
  std::string (*encode_fits)(const std::string& path, const RawPicture& raw);
  /// Read the DNG or FITS file `path`, as `read_raw_picture` describes.
  RawPicture (*read_dng)(const std::string& path);
  RawPicture (*read_fits)(const std::string& path);
};

/// Name of the exported function that returns the module's `const PictureCodec*`.
inline constexpr const char* kPictureCodecSymbol = "abbe_picture_codec";

/// The function table. The first call opens the module and throws as `module_functions`.
[[nodiscard]] const PictureCodec& picture_codec();

}  // namespace abbe
