#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "io/image.h"
#include "io/inputs.h"
#include "io/raw_picture.h"
#include "sensor/readout/readout.h"
#include "sensor/response/mosaic.h"

namespace abbe {

/// What a raw file that Abbe wrote tells of its codes.
struct RawScale {
  int bits = 16;
  double offset_dn = 0;                 ///< The code of darkness.
  std::optional<double> saturation_dn;  ///< The code at which the camera clips, if below the highest.
  std::optional<double> exposure_s;
  std::map<std::string, double> own_exposure_s;  ///< Of channels that have one of their own.
  std::optional<double> gain_e_per_dn;
  std::optional<double> electrons_per_lx_s;  ///< Of the most sensitive channel.
  std::optional<Readout> curved;             ///< The read-out, where its codes lie on no line.
  std::vector<std::uint16_t> linear_codes;   ///< What they stand for on one; empty where they are.
  std::vector<std::string> channels;         ///< Of the mosaic, in its order.
  std::optional<Mosaic> mosaic;

  /// The exposure time of a channel; nothing where the file tells none.
  [[nodiscard]] std::optional<double> exposure_of(const std::string& channel) const {
    const auto own = own_exposure_s.find(channel);
    return own == own_exposure_s.end() ? exposure_s : own->second;
  }
  /// The highest code that occurs.
  [[nodiscard]] double highest() const {
    if (saturation_dn) return std::floor(*saturation_dn);
    return static_cast<double>((1U << static_cast<unsigned>(bits)) - 1);
  }
  /// The code that a sensor without the response curve would have given for this one.
  [[nodiscard]] double linear(double code) const {
    if (linear_codes.empty()) return code;
    return linear_codes[std::min(static_cast<std::size_t>(code), linear_codes.size() - 1)];
  }
};

/// Reads that of an image's attributes; nothing for a file that tells of no read-out. Throws Error{input} for
/// a read-out with a response curve that makes no sense.
[[nodiscard]] std::optional<RawScale> raw_scale(const Image& image);

/// A raw picture as an image: a channel of codes for each plane, with what the picture tells as attributes.
[[nodiscard]] Image code_planes(const RawPicture& raw);
/// Warnings of the optional opcodes of a DNG that are not applied, one sentence each.
[[nodiscard]] std::vector<std::string> ignored_opcodes(const RawPicture& raw, const std::string& file);
/// The mosaic of a raw picture; nothing for one without.
[[nodiscard]] std::optional<Mosaic> mosaic_of(const RawPicture& raw);

/// Makes attributes of the lines "key: value" that a TIFF, so a DNG, has in their place (`ImageDescription`);
/// those that it has besides stay.
void tell_lines(Image& image);

/// Leaves out the alpha channel of a picture, which tells how opaque its pixels are.
void drop_alpha(Image& image);

/// Calls the planes of a raw TIFF or PNG, which these call R, G and B, as the file tells the sensor's. Where
/// it tells of other numbers of planes, an alpha channel that another program has put beside them is dropped.
void name_planes(Image& image);

/// An image whose 16-bit codes are shares of 65535, and what is told of them.
struct RawImage {
  Image image;
  std::optional<RawScale> scale;
  std::vector<std::string> warnings = {};  ///< About the file, each of which names it.
};

/// Reads a DNG or FITS by `read_raw_picture`, its codes as they are and not as a raw converter shows them,
/// and any other image by `read_image`, as stored beside an alpha channel; codes by a response curve that the
/// file tells are those of a straight line, as the table of a DNG makes them. What a DNG or FITS of another
/// program tells of its levels, pattern and exposure counts too. Opcodes of a DNG behind linearisation, which
/// would make other values than the sensor's own of its codes, are an error where they are mandatory. Codes
/// of a sensor are "Linear" by the attribute `kColorSpace`, as floats are, and lines of their description are
/// attributes (`tell_lines`). Throws Error{input} and Error{resource}.
[[nodiscard]] RawImage read_raw_image(const std::filesystem::path& path, Inputs* inputs = nullptr);
/// The 16-bit code that a value of an image from `read_image` stands for.
[[nodiscard]] double code_of(float value);

/// The codes of each channel of a raw file, those of a mosaic apart: whole numbers as `double`s, of the
/// pixels that were rendered (`recorded_pixels`). `image` is as `read_raw_image` gives it, in which 65535 is
/// 1.
struct ChannelCodes {
  /// How many codes lie one after the other in a row of the image.
  struct RowCodes {
    int y;
    std::size_t count;
  };
  std::string channel;
  std::vector<double> dn;
  std::vector<RowCodes> rows = {};  ///< Of all codes, in their order.
};
[[nodiscard]] std::vector<ChannelCodes> raw_codes(const Image& image, const RawScale& scale);

}  // namespace abbe
