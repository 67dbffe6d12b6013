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

/// Code that images of 16 bits hold as 1.
inline constexpr double kSixteenBits = 65535;

/// Scale of the codes in a raw file, as the file records it. Members that it does not record are empty or
/// have their defaults.
struct RawScale {
  int bits = 16;         ///< Bits of the codes as read out.
  double offset_dn = 0;  ///< Code of darkness [DN].
  /// Code at which the camera clips [DN], if below the highest of its bits.
  std::optional<double> saturation_dn;
  std::optional<double> exposure_s;  ///< Exposure time of the sensor [s].
  /// Exposure times [s] of channels that have their own, by name.
  std::map<std::string, double> own_exposure_s;
  std::optional<double> gain_e_per_dn;  ///< Electrons per DN of a linear response.
  /// Electrons in a pixel of the most sensitive channel per lx s of daylight.
  std::optional<double> electrons_per_lx_s;
  std::optional<Readout> curved;  ///< Set if the read-out has a response curve.
  /// Linearised code for each code of the file; empty if the codes are linear.
  std::vector<std::uint16_t> linear_codes;
  std::vector<std::string> channels;  ///< Channels of the mosaic, in its order.
  std::optional<Mosaic> mosaic;       ///< Pattern of the channels; empty if each plane is one channel.

  /// Exposure time of a channel [s]; empty if the file records none.
  [[nodiscard]] std::optional<double> exposure_of(const std::string& channel) const {
    const auto own = own_exposure_s.find(channel);
    return own == own_exposure_s.end() ? exposure_s : own->second;
  }
  /// Highest code that can occur [DN], before linearisation.
  [[nodiscard]] double highest() const {
    if (saturation_dn) return std::floor(*saturation_dn);
    return static_cast<double>((1U << static_cast<unsigned>(bits)) - 1);
  }
  /// Code that a sensor without the response curve would have given for this one. Codes above the table give
  /// its last entry.
  [[nodiscard]] double linear(double code) const {
    if (linear_codes.empty()) return code;
    return linear_codes[std::min(static_cast<std::size_t>(code), linear_codes.size() - 1)];
  }
};

/// Reads the scale from the attributes that Abbe writes, as metadata or as lines of an `ImageDescription`.
/// Empty if they record no read-out. Throws Error{input} for a read-out with an invalid response curve.
[[nodiscard]] std::optional<RawScale> raw_scale(const Image& image);

/// A raw picture as an image: its codes [DN] as floats, one channel per plane, with the picture's metadata as
/// attributes.
[[nodiscard]] Image code_planes(const RawPicture& raw);
/// Warnings of a DNG's optional opcodes that are not applied, one sentence each, which begins with `file`.
[[nodiscard]] std::vector<std::string> ignored_opcodes(const RawPicture& raw, const std::string& file);
/// Mosaic of a raw picture; empty if it has none.
[[nodiscard]] std::optional<Mosaic> mosaic_of(const RawPicture& raw);

/// Turns the lines "key: value" of `ImageDescription` into attributes that the image does not have yet.
void add_description_attributes(Image& image);

/// Removes the alpha channel of a picture.
void drop_alpha(Image& image);

/// Renames the planes R, G and B of a raw TIFF or PNG to the sensor channels that the file records. If their
/// number differs, an alpha channel, which another program has added, is removed first. If it still differs,
/// or if no channels are recorded, the names remain.
void name_planes(Image& image);

/// An image as `read_raw_image` returns it. Codes are divided by `kSixteenBits`.
struct RawImage {
  Image image;
  std::optional<RawScale> scale;           ///< Scale of the sensor's codes; empty if the file records none.
  std::vector<std::string> warnings = {};  ///< Each warning names the file.
};

/// Reads the codes of a raw file or of any other image.
///
/// - DNG and FITS: `read_raw_picture` gives the codes as they are, not as a raw converter would show them.
///   Levels, pattern and exposure of files by other programs are read too. Opcodes that follow linearisation
///   would change the sensor's own values: mandatory ones are an error, optional ones a warning.
/// - Any other image: `read_image`, without multiplication by an alpha channel.
///
/// If the file records a response curve, codes become those of a straight line, as the table of a DNG makes
/// them. Codes of a sensor get the attribute `kColorSpace` "Linear", as floats have, and the lines of their
/// description become attributes (`add_description_attributes`).
/// `inputs`, unless null, reserves the memory of the image; it does not record the file. Throws Error{input}
/// for a file that cannot be read, Error{resource} for one that is too large.
[[nodiscard]] RawImage read_raw_image(const std::filesystem::path& path, Inputs* inputs = nullptr);
/// The 16-bit code of a value in an image from `read_raw_image` or `read_image`: 65535 times the value,
/// rounded to a whole number. It is not limited to the range of codes.
[[nodiscard]] double code_of(float value);

/// Codes of one channel of a raw file.
struct ChannelCodes {
  /// Codes of one row of one rendered area.
  struct RowCodes {
    int y;              ///< Row of the image, from the top.
    std::size_t count;  ///< Number of consecutive codes from this row in `dn`.
  };
  std::string channel{};
  std::vector<std::uint16_t> dn{};  ///< Codes [DN], row by row.
  std::vector<RowCodes> rows{};     ///< Rows of all codes, in the order of `dn`.
};
/// Codes of each channel of a raw file, with the channels of a mosaic separated, of the pixels that were
/// rendered (`recorded_pixels`). `image` is as `read_raw_image` returns it, where 65535 is 1.
[[nodiscard]] std::vector<ChannelCodes> raw_codes(const Image& image, const RawScale& scale);

/// True if the values of an image are the codes of the sensor that its `scale` describes. Films and developed
/// or converted pictures copy that description from a raw file, but have other values.
[[nodiscard]] bool holds_sensor_codes(const RawImage& read);

/// Smallest code [DN] at which a pixel of a raw file counts as saturated. It is the attribute
/// `white_level_dn`, which Abbe's files have, otherwise `RawScale::highest`. Like the codes that
/// `read_raw_image` returns, it is linearised if the file records a response curve.
[[nodiscard]] double white_dn(const Image& image, const RawScale& scale);

/// Code at which a picture clips.
struct ClippingLevel {
  double dn;  ///< In the scale of 16-bit codes; `white_dn` for a raw file.
  /// True if the file records it as white level; false if it is the highest code of the format.
  bool is_declared;
};

/// Clipping level of a picture that is not a film:
/// - empty if a value is not a 16-bit code;
/// - `white_dn` if the picture holds sensor codes (`holds_sensor_codes`);
/// - otherwise 65535 if a pixel has that code, and empty if none has. A white level that a converter copied
///   from a raw file is ignored.
[[nodiscard]] std::optional<ClippingLevel> clipping_level(const RawImage& read);

}  // namespace abbe
