#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "io/diagnostics.h"
#include "spectral/library.h"

namespace abbe {

/// A camera's spectral sensitivities, by the names of its channels, from the JSON of rawtoaces and physlight:
/// `spectral_data` with `index` `main`, the channels' names, and `data` `main`, from wavelength [nm] to a
/// value for each channel; the files mean responses to energy. Zero beyond the table. The header and other
/// members are not looked at.
/// Reports units other than "relative", wavelengths out of order or outside [300, 1100] nm, rows of another
/// length, and values that are no numbers.
[[nodiscard]] std::optional<std::vector<NamedCurve>> read_camera_json(const std::filesystem::path& path,
                                                                      Diagnostics& diagnostics);

}  // namespace abbe
