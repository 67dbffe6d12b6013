#pragma once

#include <filesystem>
#include <optional>

#include "description/doors/shared/door.h"
#include "spectral/rgb.h"

namespace abbe::doors {

/// The mean linear Rec.709 colour of an image's pixels, those of files with 8 or 16 bits decoded as sRGB and
/// negative values taken as 0. Reports, at `where`, a file that is missing or no image, one without channels
/// R, G, B or Y, and values that are not finite.
[[nodiscard]] std::optional<LinearRgb> mean_colour(const std::filesystem::path& file,
                                                   const SourcePosition& where, Door& door);

}  // namespace abbe::doors
