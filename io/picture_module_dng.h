#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <tiffio.h>

#include "io/raw_picture.h"

namespace abbe::picture_module {

/// PhotometricInterpretation of demosaicked raw data [DNG, "LinearRaw"].
constexpr std::uint16_t kLinearRaw = 34892;

using Tiff = std::unique_ptr<TIFF, decltype(&TIFFClose)>;
using TiffOptions = std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)>;

/// Options that silence libtiff: its messages on stderr would duplicate the program's errors.
TiffOptions quiet_tiff();

/// Tags of the opcode lists 1, 2 and 3 of a raw picture [DNG, ch. 7].
constexpr std::array<std::uint32_t, 3> kOpcodeLists{51008, 51009, 51022};

/// Registers DNG tags that libtiff does not know and would warn about, once for the process. Call it before a
/// file is opened. Thread-safe.
void register_dng_tags();

/// Pixels that an opcode changes: every `row_pitch`-th row and `column_pitch`-th column from (`left`, `top`)
/// on, in `planes` planes from `plane` on. Rows and columns [px] are numbered from 0 at the top left. The
/// part outside the image is ignored.
struct OpcodeArea {
  std::uint32_t top, left, bottom, right;  ///< `bottom` and `right` are exclusive.
  std::uint32_t plane, planes;
  std::uint32_t row_pitch, column_pitch;  ///< At least 1.
};

/// A grid of gain factors for multiplication. Spacings and origins are fractions of the height and width of
/// the image from its top left corner. Gains are interpolated bilinearly at pixel centers and constant
/// outside the grid.
struct GainMap {
  std::uint32_t rows, columns;
  double row_spacing, column_spacing;
  double row_origin, column_origin;
  std::uint32_t planes;      ///< If fewer than those of the area, the last one serves for the rest.
  std::vector<float> gains;  ///< By row, by column, by plane.
};

/// An opcode that changes each pixel independently: a GainMap, or a MapPolynomial if `map.gains` is empty.
struct PixelOpcode {
  OpcodeArea area;
  GainMap map = {};
  std::vector<double> polynomial{};  ///< Coefficients of 1, x, x^2 and so on; at most degree 8.
};

/// An opcode list of a DNG [DNG, ch. 7].
struct OpcodeList {
  std::vector<PixelOpcode> opcodes;  ///< Supported opcodes, in order.
  std::vector<DngOpcode> names;      ///< All opcodes of the list.
};

/// Parses opcode list number `list`, 1 to 3. Throws Error{input}, which names the file `path`, if the bytes
/// are damaged, or if a mandatory opcode is not supported.
OpcodeList parse_opcodes(std::span<const std::uint8_t> bytes, int list, const std::string& path);

/// Pixels to which opcodes are applied: values pixel by pixel, interleaved by plane.
struct OpcodeImage {
  std::int64_t width, height;
  std::size_t planes;
  std::span<float> values;
  double unit;  ///< A MapPolynomial p changes a value v to unit * p(v / unit).
  /// The mosaic pattern and its width if opcodes address the channels of the mosaic as planes; 0 otherwise.
  std::span<const std::uint8_t> mosaic = {};
  std::int64_t mosaic_width = 0;
};

/// Applies opcodes in order to `image.values`. Values are not clipped: saturation is decided by the stored
/// code.
void apply_opcodes(const std::vector<PixelOpcode>& opcodes, const OpcodeImage& image);

}  // namespace abbe::picture_module
