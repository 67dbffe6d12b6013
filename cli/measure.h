#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <Imath/ImathVec.h>

#include "io/inputs.h"

namespace abbe::cli {

/// Request to detect the corners of a chart in each image.
struct FindCorners {};
/// Corners of a chart in images without a scene, or the request to detect them. The order and the unit are
/// those of `outlines_between`.
using ChartCorners = std::variant<FindCorners, std::array<Imath::V2d, 4>>;

/// Options of `abbe measure`.
struct MeasureOptions {
  std::vector<std::filesystem::path> images;  ///< Films, spectral films, raw files and other pictures.
  std::string chart;  ///< A scene with a chart; if corners are given, a table of its patches.
  /// Corners of a chart without a scene; empty if a scene gives them.
  std::optional<ChartCorners> corners;
  std::size_t columns = 6;       ///< Patches per row of a chart with corners.
  std::filesystem::path flat;    ///< Picture of a uniform surface for flat-fielding; empty for none.
  std::filesystem::path output;  ///< CSV table of the results; empty for none.
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;  ///< Print the answer as JSON instead of tables.
};

/// Measures the patches of a chart in images of any kind; prints the results and writes the table. Returns 0.
/// Throws Error{usage} if `chart` does not suit `corners`, and if images for one table differ in channels or
/// unit. Throws Error{input} naming the image if it cannot be read or measured, Error{output} if the table
/// cannot be written.
int measure(const MeasureOptions& options);

}  // namespace abbe::cli
