#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibration/chart/exposure_series.h"
#include "calibration/chart/measured_patches.h"
#include "io/diagnostics.h"
#include "io/inputs.h"

namespace abbe {

/// The exposure series of each channel of a camera.
struct PhotographedSeries {
  /// Names of the channels: R, G and B first, then others in the order of the file.
  std::vector<std::string> channels;
  /// One series per channel, whose patches are the regions and whose times are in the order of the listing.
  std::vector<ExposureSeries> series;
  FullScale full_scale = {};  ///< Value of the photographs at code 1.
};

/// Reads photographs of one still scene (any picture format, EXR too) listed in a JSON file:
///
///     {"exposures": [{"file": "a.tif", "exposure_s": 0.01}, ...],
///      "regions": [[x0, y0, x1, y1], ...], "full_scale": 1, "bits": 12}
///
/// Paths are relative to that file.
///
/// Regions: each one is a patch of the pixels x0 to x1 - 1 and y0 to y1 - 1.
/// - Its code is the median of its pixels. Its deviation is the standard error of the median, from the
///   scatter of the pixels and from rounding to `bits`.
/// - Its code is 0 or 1 if more of its pixels are black or clipped than may be defective (`exceeds_defects`).
/// - A region without scatter, such as a single pixel, leaves the noise of its channel unknown.
/// - Without regions, the patches are single pixels of a regular grid, with unknown noise.
///
/// Scale: code 0 is black, and code 1 is `full_scale`, the value of the file at which the camera clips.
/// - Raw files supply what the listing omits: exposure time, full scale (their white level), black level,
///   bits, and the mosaic, each channel of which is a series.
/// - Other files need `exposure_s`. Their black is 0 and their default full scale 1, the largest value of an
///   integer file.
///
/// Channels are the sensor planes that a file records, otherwise all planes but alpha and variances.
///
/// Returns nothing after an error in `diagnostics`:
/// - a malformed listing, and a photograph without an exposure time;
/// - photographs of unequal size or channels, and raw files among others;
/// - regions outside the photographs, and values that are not finite;
/// - a `full_scale` that is not a code of raw files above their black.
///
/// Warns if a region shows that the camera clips below `full_scale`. Throws Error{input} or Error{resource}
/// as `read_raw_image` for a photograph that cannot be read. `inputs`, unless null, records all files and
/// limits their memory.
[[nodiscard]] std::optional<PhotographedSeries> read_series(const std::filesystem::path& path,
                                                            Diagnostics& diagnostics,
                                                            Inputs* inputs = nullptr);

}  // namespace abbe
