#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "io/diagnostics.h"
#include "spectral/library.h"

namespace abbe {

/// Reads the spectral sensitivities of a camera from the JSON of rawtoaces and physlight. Curves are named by
/// channel, in the order of the file. `spectral_data` contains the names of the channels in `index.main`. Its
/// `data.main` maps wavelengths [nm] to one value per channel. The values are responses to energy and zero
/// outside the table. Other members are ignored. Reports errors and returns nothing for
/// - a file that cannot be read or parsed, or lacks one of these members;
/// - units other than "relative";
/// - fewer than two wavelengths, wavelengths out of order or outside [300, 1100] nm;
/// - rows of another length, and values that are not numbers.
[[nodiscard]] std::optional<std::vector<NamedCurve>> read_camera_json(const std::filesystem::path& path,
                                                                      Diagnostics& diagnostics);

}  // namespace abbe
