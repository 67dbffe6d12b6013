#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "io/raw_picture.h"

namespace abbe::picture_module {

/// Pixels of an image that an opcode changes: every `row_pitch`-th row and `column_pitch`-th column from its
/// top left corner, in planes from `plane` on.
struct OpcodeArea {
  std::uint32_t top, left, bottom, right;  ///< The last row and column are excluded.
  std::uint32_t plane, planes;
  std::uint32_t row_pitch, column_pitch;
};

/// The factors of a GainMap at the points of a grid, in fractions of the image from its top left corner.
struct GainMap {
  std::uint32_t rows, columns;
  double row_spacing, column_spacing;
  double row_origin, column_origin;
  std::uint32_t planes;
  std::vector<float> gains;  ///< By row, by column, by plane.
};

/// An opcode that changes each pixel for itself: a GainMap, or a MapPolynomial where the map has no gains.
struct PixelOpcode {
  OpcodeArea area;
  GainMap map = {};
  std::vector<double> polynomial{};  ///< Coefficients of 1, x, x^2 and so on.
};

/// An opcode list of a DNG [DNG, ch. 7].
struct OpcodeList {
  std::vector<PixelOpcode> opcodes;  ///< Those that are applied here, in their order.
  std::vector<DngOpcode> names;      ///< All of them.
};

/// Parses the bytes of the list of that number, 1 to 3. Throws Error{input} naming `path` for damaged bytes,
/// and by name for a mandatory opcode that is not applied here.
OpcodeList parse_opcodes(std::span<const std::uint8_t> bytes, int list, const std::string& path);

/// Pixels that opcodes change: values pixel by pixel, in each plane by plane.
struct OpcodeImage {
  std::int64_t width, height;
  std::size_t planes;
  std::span<float> values;
  double unit;  ///< The value that a MapPolynomial takes for 1.
  /// The pattern of a mosaic whose opcodes count channels as planes, and its width; 0 where planes are
  /// planes.
  std::span<const std::uint8_t> mosaic = {};
  std::int64_t mosaic_width = 0;
};

/// Applies opcodes in their order. Values are not clipped: a pixel is saturated by its code.
void apply_opcodes(const std::vector<PixelOpcode>& opcodes, const OpcodeImage& image);

}  // namespace abbe::picture_module
