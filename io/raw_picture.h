#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace abbe {

/// Calibration of a camera under one light [DNG, ch. 6]. Matrices are stored row by row.
struct RawLight {
  int illuminant;                   ///< CalibrationIlluminant: Exif's number of the light, 255 for others.
  std::array<double, 9> color{};    ///< ColorMatrix: XYZ, not adapted, to linear camera values.
  std::array<double, 9> forward{};  ///< ForwardMatrix: balanced camera values to XYZ relative to D50.
};

/// A correction that an opcode list of a DNG requests [DNG, ch. 7].
struct DngOpcode {
  std::string name;
  int list;  ///< 1: applies to stored codes, 2: after linearisation, 3: after demosaicking.
  bool is_optional;
  bool is_applied;

  [[nodiscard]] std::string text() const { return name + " of OpcodeList" + std::to_string(list); }
};

/// Sensor codes as a raw file stores them, with the properties that raw developers need.
struct RawPicture {
  std::int64_t width = 0;
  std::int64_t height = 0;
  std::vector<std::string>
      planes;  ///< Names of the values of a pixel: one for a mosaic or a grey sensor, or several.
  std::vector<std::uint16_t> codes;       ///< Pixel by pixel from the top left, interleaved by plane.
  std::vector<std::string> channels;      ///< Equal to `planes`, or the channels of the mosaic.
  std::int64_t mosaic_width = 0;          ///< 0 without a mosaic.
  std::vector<std::uint8_t> mosaic = {};  ///< Indices into `channels`, rows of the pattern from the top.
  double black_level_dn = 0;  ///< Expected code without light, after linearisation if codes are not linear.
  double white_level_dn = 65535;                 ///< Code of saturated pixels.
  std::vector<std::uint16_t> linear_codes = {};  ///< Linear value of each code; empty if codes are linear.
  bool is_linearised = false;  ///< True if the codes were read through the file's linearisation table.
  std::vector<DngOpcode> opcodes = {};  ///< Opcodes of a DNG; list 1 has been applied to `codes`.
  /// Codes minus black level with opcode lists 2 and 3 applied, in the order of `codes`; empty without such
  /// opcodes.
  std::vector<float> corrected = {};
  double gain_e_per_dn = 1;
  double read_noise_e = 0;
  double full_well_e = 0;            ///< 0 if there is no limit.
  std::optional<double> exposure_s;  ///< Nothing if channels differ, or the file does not record it.
  std::optional<double> f_number;
  std::optional<double> iso_speed;
  std::vector<RawLight> lights =
      {};  ///< The film's light, or two calibrated lights; empty without colour calibration.
  /// Linear codes above black of the reference white, scaled to a maximum of 1 (AsShotNeutral); only with
  /// `lights`.
  std::optional<std::array<double, 3>> neutral = {};
  std::string camera;                           ///< Name of the camera.
  std::map<std::string, std::string> metadata;  ///< All attributes of the film.
};

/// Writes a DNG 1.4 file [DNG]: a mosaic of three channels, one plane, or three planes. Channels called R, G
/// and B are written in that order. Throws Error{output}, also for other channel counts.
void write_dng(const std::filesystem::path& path, const RawPicture& raw);

/// Writes a FITS image [FITS4] of unsigned 16-bit integers. Planes are the third axis; the first row is the
/// top (`ROWORDER`). Throws Error{output}.
void write_fits(const std::filesystem::path& path, const RawPicture& raw);

/// Reads a raw picture:
/// - a DNG with unsigned 16-bit codes, uncompressed or in a TIFF compression, with one black and one white
///   level;
/// - a FITS image of integers from 0 to 65535, first row at the top unless its `ROWORDER` is BOTTOM-UP.
/// The result has the codes, mosaic, levels, exposure and gain that the file records. Files written by Abbe
/// also record the attributes of the film. Codes of a DNG are read through its linearisation table. GainMap
/// and MapPolynomial opcodes are applied; other optional opcodes are listed, other mandatory ones are errors.
/// Channels of a mosaic are R, G and B, unless a DNG of Abbe names others. Throws Error{input}, and
/// Error{resource} beyond the limits of `io/image.h`.
[[nodiscard]] RawPicture read_raw_picture(const std::filesystem::path& path);

/// True if `read_raw_picture` reads files of this extension: .dng, .fits or .fit, in either case.
[[nodiscard]] bool is_raw_picture(const std::filesystem::path& path);

}  // namespace abbe
