#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "io/diagnostics.h"
#include "io/raw_picture.h"

namespace abbe {

/// Reads the two lights of a `dng.json` that `abbe calibrate` wrote, the warmer first. Reports, as an input,
/// a file that has not two of them with their matrices, and a light without a number in Exif, by which raw
/// converters know its temperature; then returns nothing.
[[nodiscard]] std::optional<std::vector<RawLight>> read_dng_profile(const std::filesystem::path& path,
                                                                    Diagnostics& diagnostics);

}  // namespace abbe
