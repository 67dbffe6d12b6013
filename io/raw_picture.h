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
  /// CalibrationIlluminant: Exif's number of the light, such as 21 for D65; 255 for others.
  int illuminant;
  std::array<double, 9> color{};    ///< ColorMatrix: XYZ, not adapted, to linear camera values.
  std::array<double, 9> forward{};  ///< ForwardMatrix: balanced camera values to XYZ relative to D50.
};

/// A correction that an opcode list of a DNG requests [DNG, ch. 7].
struct DngOpcode {
  std::string name;
  int list;          ///< 1: applies to stored codes, 2: after linearisation, 3: after demosaicking.
  bool is_optional;  ///< True if the file allows readers to skip it.
  bool is_applied;   ///< True if the reader applies it.

  /// Such as "GainMap of OpcodeList2".
  [[nodiscard]] std::string text() const { return name + " of OpcodeList" + std::to_string(list); }
};

/// Sensor codes [DN] as a raw file stores them. A property that a reader does not find has its default.
struct RawPicture {
  std::int64_t width = 0;
  std::int64_t height = 0;
  /// Names of the values of a pixel: one for a mosaic or a grey sensor, or several.
  std::vector<std::string> planes;
  std::vector<std::uint16_t> codes;   ///< Pixel by pixel from the top left, interleaved by plane.
  std::vector<std::string> channels;  ///< Equal to `planes`, or the channels of the mosaic.
  std::int64_t mosaic_width = 0;      ///< Columns of the mosaic pattern [px]; 0 without a mosaic.
  /// Indices into `channels` of the pattern, row by row from the top left pixel of the picture; it repeats in
  /// both directions.
  std::vector<std::uint8_t> mosaic = {};
  /// Expected code without light. If the codes are not linear, it is a value of the linearisation table.
  double black_level_dn = 0;
  /// Code of saturated pixels. A writer takes it for a stored code; readers give it after the linearisation.
  double white_level_dn = 65535;
  /// Linear value of each stored code from 0 on, for writers; empty if codes are linear.
  std::vector<std::uint16_t> linear_codes = {};
  bool is_linearised = false;  ///< True if the codes were read through the file's linearisation table.
  std::vector<DngOpcode> opcodes = {};  ///< All opcodes of a DNG; list 1 has been applied to `codes`.
  /// Values above the black level [DN], not clipped, in the order of `codes`: codes with opcode lists 2 and 3
  /// applied, or the floats of a FITS file. Empty without such opcodes, and if all floats are whole.
  std::vector<float> corrected = {};
  double gain_e_per_dn = 1;
  double read_noise_e = 0;
  /// Full well [e-]; 0 if there is no limit.
  double full_well_e = 0;
  std::optional<double> exposure_s;  ///< Nothing if channels differ, or it is not recorded.
  std::optional<double> f_number;
  std::optional<double> iso_speed;  ///< Saturation-based ISO speed.
  /// The film's light, or two calibrated lights; empty without colour calibration.
  std::vector<RawLight> lights = {};
  /// Linear codes above black of the reference white, scaled to a maximum of 1 (AsShotNeutral); only with
  /// `lights`.
  std::optional<std::array<double, 3>> neutral = {};
  std::string camera;  ///< Name of the camera; may be empty.
  /// All attributes of the film. `read_raw_picture` gives them one by one for a FITS file. For a DNG it gives
  /// their lines `key: value` as the only attribute "ImageDescription".
  std::map<std::string, std::string> metadata;
};

/// Writes a DNG 1.4 file [DNG], atomically: a mosaic of three channels, one plane, or three planes. Channels
/// called R, G and B are written in that order. Throws Error{output} for other channel counts, or if the file
/// cannot be written. Throws Error{input} if the picture module does not load.
void write_dng(const std::filesystem::path& path, const RawPicture& raw);

/// Writes a FITS image [FITS4] of unsigned 16-bit integers, atomically. Planes are the third axis; the first
/// row is the top (`ROWORDER`). Throws Error{output} if the file cannot be written, and Error{input} if the
/// picture module does not load.
void write_fits(const std::filesystem::path& path, const RawPicture& raw);

/// Reads a raw picture, by its extension:
/// - .dng: strips of unsigned 16-bit codes, uncompressed or in a TIFF compression, with one black and one
///   white level. The picture is the active area.
/// - any other: a FITS image of 8-bit or 16-bit integers from 0 to 65535, first row at the top unless its
///   `ROWORDER` is BOTTOM-UP.
/// The result has the codes, mosaic, levels and exposure time that the file records, and the gain of a FITS
/// file. Files written by Abbe also record the attributes of the film. Other properties have their defaults.
/// Codes of a DNG are read through its linearisation table. GainMap and MapPolynomial opcodes are applied;
/// other optional opcodes are listed. Channels of a mosaic are R, G and B, unless a DNG of Abbe names others.
/// Throws Error{input} if the file is missing, damaged or of another form, has another mandatory opcode, or
/// the picture module does not load. Throws Error{resource} above the limits of `io/image.h`.
[[nodiscard]] RawPicture read_raw_picture(const std::filesystem::path& path);

/// True if `read_raw_picture` reads files of this extension: .dng, .fits or .fit, in either case.
[[nodiscard]] bool is_raw_picture(const std::filesystem::path& path);

}  // namespace abbe
