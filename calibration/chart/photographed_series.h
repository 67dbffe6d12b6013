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
  std::vector<ExposureSeries> series;  ///< One a channel.
  FullScale full_scale = {};
};

/// Reads photographs of one still scene (any picture format, EXR too) listed in a JSON file:
///
///     {"exposures": [{"file": "a.tif", "exposure_s": 0.01}, ...],
///      "regions": [[x0, y0, x1, y1], ...], "full_scale": 1, "bits": 12}
///
/// Paths are relative to that file. Each region [pixels, the last ones excluded] gives one patch: the median
/// of its code values, with the median's standard error from their spread and from rounding to `bits`. A
/// region of which more pixels are black or clipped than may be defective (`exceeds_defects`) counts as black
/// or clipped, and one without spread, as of a single pixel, leaves the noise of its channel unknown. Without
/// regions, single pixels of a regular grid are the patches, and nothing is known of their noise. Codes are
/// divided by `full_scale`, the value at which the camera clips, as the file has it. What the listing does
/// not say, raw files tell themselves, as far as `read_raw_image` has it: exposure time, full scale, which is
/// their white level, the code of darkness, bits and mosaic, of which each channel is a series; for others
/// `exposure_s` is needed, and full scale is 1, an integer file's largest. Channels are the planes of the
/// sensor that a file tells of, else all but alpha and variances. Reports photographs of unequal size or
/// channels, regions beyond them, values that are not finite, raw files among others, and a `full_scale` that
/// is no code of raw files above their black. `inputs` learns of every file.
[[nodiscard]] std::optional<PhotographedSeries> read_series(const std::filesystem::path& path,
                                                            Diagnostics& diagnostics,
                                                            Inputs* inputs = nullptr);

}  // namespace abbe
