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

/// The corners of a chart are to be found in each image.
struct FindCorners {};
/// Where a chart is in images without a scene: where its corners are [pixels], or where they are found.
using ChartCorners = std::variant<FindCorners, std::array<Imath::V2d, 4>>;

/// What `abbe measure` was asked for.
struct MeasureOptions {
  std::vector<std::filesystem::path> images;
  std::string chart;                    ///< A scene with a chart; with corners a table of one.
  std::optional<ChartCorners> corners;  ///< Of a chart without a scene.
  std::size_t columns = 6;              ///< Patches in a row of a chart with corners.
  std::filesystem::path flat;           ///< A picture of an even surface, or empty.
  std::filesystem::path output;         ///< A table, or empty.
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;
};

/// Measures the patches of a chart in images of any kind; prints and writes what each has. Returns the exit
/// code.
int measure(const MeasureOptions& options);

}  // namespace abbe::cli
