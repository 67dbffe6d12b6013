#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "calibration/chart/patches.h"
#include "io/image.h"

namespace abbe {

/// Colours of a chart's patches under one light, for a standard observer.
struct ChartTargets {
  std::vector<std::string> names;
  std::vector<XYZ> xyz;  ///< Y = 1 for the perfect diffuser.
  XYZ white;             ///< The perfect diffuser.
};

/// Colours of a chart for the CIE 1931 observer. `name` is a table of `data/reflectance` or a file.
/// - A table of reflectances is integrated under `illuminant`.
/// - An edition's table states colours under its own light, and `illuminant` is not used. It has the columns
///   `patch` and `x`, `y`, `Y` or `L`, `a`, `b`, and a line `# white_xy: x, y`. The perfect diffuser has Y =
///   1 or L = 100.
///
/// Reports an unknown name at `where`, an invalid table, and a row that states no colour or whose Y exceeds
/// 2, as a percentage does. Returns nothing after such an error.
[[nodiscard]] std::optional<ChartTargets> load_chart_targets(const std::string& name, const Curve& illuminant,
                                                             const SourcePosition& where,
                                                             Diagnostics& diagnostics);

/// Units of the values that `abbe measure` writes: for raw files, for other pictures, and for EXR films, in
/// this order.
inline constexpr const char* kNumbersAboveBlack = "digital numbers above black";
inline constexpr const char* kCodeValues = "code values in [0, 1], as the file has them";
inline constexpr const char* kFilmValues = "film values";

/// Adds a warning that values measured in the picture `file` are code values and count as linear. `instead`
/// ends its text and recommends a better input.
void warn_of_codes(const std::filesystem::path& file, const std::string& instead, Diagnostics& diagnostics);
/// Warns as `warn_of_codes` unless the attribute `kColorSpace` of the picture declares linear values.
void warn_unless_linear(const Image& picture, const std::filesystem::path& file, const std::string& instead,
                        Diagnostics& diagnostics);

/// Values that a camera recorded of named patches, with their noise.
struct MeasuredPatches {
  std::vector<std::string> names;
  std::vector<Raw> values;  ///< Values of R, G and B in `unit`, one per name.
  /// Standard deviations of the values (means over pixels), one per name; empty: unknown.
  std::vector<Raw> deviations = {};
  std::string unit = {};  ///< Text of the table's line `# unit:`; empty without that line.
  /// Names of patches with saturated pixels, whose values are too low.
  std::set<std::string> saturated = {};
};
/// Loads measured patches from a table with the columns `patch`, `R`, `G`, `B`, which names each patch once.
/// Returns nothing after an error in `diagnostics`.
///
/// Noise: the columns `R_deviation` (of one pixel), `R_pixels` and those of G and B, as `abbe measure` writes
/// them, give the standard deviations of the means. A deviation is unknown if its cell is empty, or if it is
/// 0 for one pixel. If that of a patch in use is unknown, all deviations are dropped, and a warning states
/// that all patches have equal weight. Deviations below 0 and fewer than 1 pixel are errors.
///
/// Saturation: patches are marked as saturated, with a warning, if `R_saturated`, `G_saturated` or
/// `B_saturated` is too high. A value of 1 or more is a number of pixels, and is too high if it exceeds those
/// that may be defective (`exceeds_defects`). A fraction of the pixels is too high if it is above 0, as is
/// any value without columns of pixels. In a table of deviations without these columns, patches at the
/// highest value of a channel are marked if they alone have no deviation.
[[nodiscard]] std::optional<MeasuredPatches> load_measured_patches(const std::filesystem::path& path,
                                                                   Diagnostics& diagnostics);

/// Value to which code 1 of a series of photographs corresponds.
struct FullScale {
  std::optional<double> dn = {};  ///< Digital numbers above black; set for a series of raw files only.
  double value = 1;               ///< Value of other pictures, as their files have it.
};

/// Divides values and deviations by their full scale, so that a recovered response applies to them as codes
/// from 0 to 1. Values that are neither numbers above black nor code or film values are such codes already.
/// Throws Error{input} naming `file` for numbers above black if the series is not of raw files, and for a
/// patch above 1 that is not marked as saturated.
void scale_to_codes(MeasuredPatches& patches, const FullScale& full_scale, const std::filesystem::path& file);

}  // namespace abbe
