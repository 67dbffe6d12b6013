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
  std::vector<std::string> channels;
  std::vector<ExposureSeries> series;  ///< One series per channel.
  FullScale full_scale = {};
};

/// Reads photographs of one still scene (any picture format, EXR too) listed in a JSON file:
///
///     {"exposures": [{"file": "a.tif", "exposure_s": 0.01}, ...],
///      "regions": [[x0, y0, x1, y1], ...], "full_scale": 1, "bits": 12}
///
/// Paths are relative to that file.
///
/// Regions [pixels, the last ones excluded]: each region is a patch. Its code is the median of its code
/// values, with the standard error of the median from their scatter and from rounding to `bits`. A region
/// with more black or clipped pixels than may be defective (`exceeds_defects`) counts as black or clipped. A
/// region without scatter, such as a single pixel, leaves the noise of its channel unknown. Without regions,
/// the patches are single pixels of a regular grid with unknown noise.
///
/// Scale: codes are divided by `full_scale`, the value at which the camera clips, as the file has it. Raw
/// files supply what the listing omits, as far as `read_raw_image` reads it: exposure time, full scale (their
/// white level), the code of darkness, bits, and the mosaic, each channel of which is a series. Other files
/// need `exposure_s`; their default full scale is 1, the largest value of an integer file.
///
/// Channels are the sensor planes that a file records, otherwise all planes but alpha and variances.
///
/// Reports in `diagnostics`
/// - photographs of unequal size or channels, and raw files among others;
/// - regions outside the photographs, and values that are not finite;
/// - a `full_scale` that is not a code of raw files above their black.
///
/// All files are added to `inputs`.
[[nodiscard]] std::optional<PhotographedSeries> read_series(const std::filesystem::path& path,
                                                            Diagnostics& diagnostics,
                                                            Inputs* inputs = nullptr);

}  // namespace abbe
