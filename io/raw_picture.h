#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace abbe {

/// What calibration says of a camera under one light [DNG, ch. 6]; matrices row by row.
struct RawLight {
  int illuminant;                   ///< CalibrationIlluminant: the light's number in Exif, 255 for others.
  std::array<double, 9> color{};    ///< ColorMatrix: XYZ, not adapted, to linear camera values.
  std::array<double, 9> forward{};  ///< ForwardMatrix: balanced camera values to XYZ relative to D50.
};

/// A correction that an opcode list of a DNG asks for [DNG, ch. 7].
struct DngOpcode {
  std::string name;
  int list;  ///< 1: of the codes as stored, 2: behind linearisation, 3: behind demosaicking.
  bool is_optional;
  bool is_applied;

  [[nodiscard]] std::string text() const { return name + " of OpcodeList" + std::to_string(list); }
};

/// The codes of a sensor as a raw file holds them, and what programs that develop raw files ask of it.
struct RawPicture {
  std::int64_t width = 0;
  std::int64_t height = 0;
  std::vector<std::string> planes;  ///< Names of what a pixel has: one of a mosaic or a grey sensor, or more.
  std::vector<std::uint16_t> codes;       ///< Pixel by pixel from the top left, in each plane by plane.
  std::vector<std::string> channels;      ///< The planes, or the channels of the mosaic.
  std::int64_t mosaic_width = 0;          ///< 0 without a mosaic.
  std::vector<std::uint8_t> mosaic = {};  ///< Numbers among the channels, rows of the pattern from the top.
  double black_level_dn = 0;      ///< The code that is expected without light, on a line where codes are not.
  double white_level_dn = 65535;  ///< The code that saturated pixels reach.
  std::vector<std::uint16_t> linear_codes = {};  ///< What each code stands for; empty where they are linear.
  bool is_linearised = false;  ///< Whether such a table of the file has made the codes that were read.
  std::vector<DngOpcode> opcodes = {};  ///< Those of a DNG; list 1 has changed `codes` already.
  /// The codes above black as lists 2 and 3 change them, in the order of `codes`; empty where they do not.
  std::vector<float> corrected = {};
  double gain_e_per_dn = 1;
  double read_noise_e = 0;
  double full_well_e = 0;            ///< 0 where there is no limit.
  std::optional<double> exposure_s;  ///< Nothing where channels differ, or a file does not tell.
  std::optional<double> f_number;
  std::optional<double> iso_speed;
  std::vector<RawLight> lights = {};  ///< The film's own, or two calibrated ones; none without colours.
  /// Linear codes above black of the white, of which the greatest is 1 (AsShotNeutral); with lights alone.
  std::optional<std::array<double, 3>> neutral = {};
  std::string camera;                           ///< Its name.
  std::map<std::string, std::string> metadata;  ///< All that the film tells.
};

/// Writes a DNG 1.4 [DNG]: a mosaic of three channels, one plane, or three, in the order R, G, B where they
/// have these names. Throws Error{output}, also for any other sensor.
void write_dng(const std::filesystem::path& path, const RawPicture& raw);

/// Writes a FITS image [FITS4] of unsigned 16-bit numbers, planes as its third axis, the first row first
/// (`ROWORDER`). Throws Error{output}.
void write_fits(const std::filesystem::path& path, const RawPicture& raw);

/// Reads a DNG whose codes are stored as 16-bit numbers without sign, uncompressed or as TIFF compresses,
/// with one black and one white level, or a FITS image of whole numbers from 0 to 65535, the first row first
/// unless its `ROWORDER` is BOTTOM-UP: codes, mosaic, black and white level, exposure, gain and, of a file
/// that Abbe wrote, what the film told, as far as the file tells them; of a DNG with a linearisation table
/// what that makes of the codes. Opcodes GainMap and MapPolynomial of a DNG are applied, other optional ones
/// are only listed, and other mandatory ones are an error. Channels of a mosaic are R, G and B, or those that
/// a DNG of ours names. Throws Error{input}, or Error{resource} for one beyond the limits of `io/image.h`.
[[nodiscard]] RawPicture read_raw_picture(const std::filesystem::path& path);

/// Whether a file is one for `read_raw_picture`, by its extension: .dng, .fits or .fit, in either case.
[[nodiscard]] bool is_raw_picture(const std::filesystem::path& path);

}  // namespace abbe
