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
/// Corners of a chart [pixels] in images without a scene, or the request to detect them.
using ChartCorners = std::variant<FindCorners, std::array<Imath::V2d, 4>>;

/// Options of `abbe measure`.
struct MeasureOptions {
  std::vector<std::filesystem::path> images;
  std::string chart;  ///< A scene with a chart; if corners are given, a table of its patches.
  std::optional<ChartCorners> corners;  ///< Corners of a chart without a scene.
  std::size_t columns = 6;              ///< Patches per row of a chart with corners.
  std::filesystem::path flat;           ///< Picture of a uniform surface for flat-fielding; empty for none.
  std::filesystem::path output;         ///< CSV table of the results; empty for none.
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;
};

/// Measures the patches of a chart in images of any kind; prints the results and writes the table. Returns
/// the exit code.
int measure(const MeasureOptions& options);

}  // namespace abbe::cli
