#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "calibration/chart/patches.h"
#include "io/image.h"

namespace abbe {

/// What an observer sees of a chart's patches under one light.
struct ChartTargets {
  std::vector<std::string> names;
  std::vector<XYZ> xyz;  ///< Y = 1 for the perfect diffuser.
  XYZ white;             ///< The perfect diffuser.
};

/// The colours of a chart: of a table of reflectances under `illuminant` for the CIE 1931 observer, or as an
/// edition's table states them (columns `patch` and `x`, `y`, `Y` or `L`, `a`, `b`, and a line `# white_xy:
/// x, y`) under its own light, whatever `illuminant` is. Y is 1 and L 100 of the perfect diffuser; a row with
/// a Y above 2, as in percent, is reported, as is one that states no colour.
[[nodiscard]] std::optional<ChartTargets> load_chart_targets(const std::string& name, const Curve& illuminant,
                                                             const SourcePosition& where,
                                                             Diagnostics& diagnostics);

/// The units of what `abbe measure` reads out of raw files, out of other pictures, and out of EXR files.
inline constexpr const char* kNumbersAboveBlack = "digital numbers above black";
inline constexpr const char* kCodeValues = "code values in [0, 1], as the file has them";
inline constexpr const char* kFilmValues = "film values";

/// Warns that the code values of a picture, out of which `file` is or was measured, are taken for linear, and
/// tells what to do instead.
void warn_of_codes(const std::filesystem::path& file, const std::string& instead, Diagnostics& diagnostics);
/// Warns so of a picture, unless its attribute `kColorSpace` says that its values are linear.
void warn_unless_linear(const Image& picture, const std::filesystem::path& file, const std::string& instead,
                        Diagnostics& diagnostics);

/// A camera's values of named patches, each named once, from a table with the columns `patch`, `R`, `G`, `B`;
/// with `R_deviation` (of a pixel), `R_pixels` and those of G and B, as `abbe measure` writes them, it tells
/// their noise too, unless that of a patch that is not left out is unknown: of an empty cell, or a
/// deviation of 0 of one pixel, a warning tells that all count alike. Deviations below 0 and fewer pixels
/// than 1 are errors at any rate. Where `R_saturated`, `G_saturated` or `B_saturated` is more than may be
/// defective of `R_pixels`, `G_pixels` or `B_pixels` (`exceeds_defects`), or above 0 without these columns, a
/// warning names the patch as left out. A table without such columns but with deviations leaves out patches
/// at the highest value of a channel that have no deviation, if all others have one.
struct MeasuredPatches {
  std::vector<std::string> names;
  std::vector<Raw> values;
  std::vector<Raw> deviations = {};  ///< Standard deviations of the values; empty: unknown.
  std::string unit = {};             ///< As the table has it.
  std::set<std::string> saturated =
      {};  ///< Names of patches that the light saturates, whose values are too low.
};
[[nodiscard]] std::optional<MeasuredPatches> load_measured_patches(const std::filesystem::path& path,
                                                                   Diagnostics& diagnostics);

/// What code 1 of a series of photographs stands for.
struct FullScale {
  std::optional<double> dn = {};  ///< Digital numbers above black, where they are raw files.
  double value = 1;               ///< Of other pictures, as their files have it.
};

/// Makes values those of the codes that a recovered response is of, 0 to 1: numbers above black, and values
/// of other pictures, are divided by the full scale of the series; of any other unit they are such codes.
/// Throws Error{input} naming `file` for numbers above black where the series is of no raw files, and for a
/// patch with a value beyond 1 that is not left out as saturated.
void scale_to_codes(MeasuredPatches& patches, const FullScale& full_scale, const std::filesystem::path& file);

}  // namespace abbe
