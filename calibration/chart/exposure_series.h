#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calibration/chart/measured_patches.h"
#include "io/diagnostics.h"
#include "io/inputs.h"

namespace abbe {

/// A known camera response from linear exposure to code values in [0, 1], for tests of its recovery.
class PlantedResponse {
 public:
  /// Parses "linear", "gamma:G" (code = x^(1/G), G in [0.2, 5]) or "s-curve". The latter is a film-like
  /// characteristic with toe and shoulder, code = x^p (1 + s)/(x^p + s) with p = 1.4, s = 0.18^p. Throws
  /// Error{usage} for anything else.
  explicit PlantedResponse(const std::string& description);

  /// Code value in [0, 1] of a linear exposure, which is first clipped to [0, 1].
  [[nodiscard]] double code(double exposure) const;
  /// Linear exposure in [0, 1] of a code value: the inverse of `code`. Codes are first clipped to [0, 1].
  [[nodiscard]] double exposure(double code) const;

 private:
  double power_ = 1;
  double shoulder_ = 0;  // s; 0 for a pure power
};

/// Noise of code values, with full scale 1. A code z has independent Gaussian noise of variance `read`^2 +
/// `shot` z. Rounding to `bits` bits, steps of 1/(2^bits - 1), then adds a twelfth of a squared step.
struct CodeNoise {
  int bits = 0;     ///< Bits of the codes; 0 for no rounding.
  double read = 0;  ///< Standard deviation of dark codes.
  double shot = 0;  ///< Variance per unit of code.

  /// Standard deviation of a code whose noiseless value is `code`, rounding included.
  [[nodiscard]] double deviation(double code) const;
};

/// One channel's code values of every patch at every exposure time. Code 0 is black, code 1 clipped.
struct ExposureSeries {
  std::vector<double> times_s;             ///< Exposure times in any order.
  std::vector<std::vector<double>> codes;  ///< codes[patch][time], each in [0, 1].
  /// Standard deviations of the codes, deviations[patch][time]; empty if they are unknown.
  std::vector<std::vector<double>> deviations;
};

/// Simulates photographs of `values` (linear; 1 gives full scale in one second) with the exposure times
/// `times_s` through a response. Codes are clipped to [0, 1] after the noise. The result states the
/// deviations of the noise at the codes, unless the camera has neither noise nor rounding. The noise is a
/// function of `seed`.
[[nodiscard]] ExposureSeries expose(std::span<const double> values, std::span<const double> times_s,
                                    const PlantedResponse& response, const CodeNoise& noise,
                                    std::uint64_t seed = 1);

/// The exposure series of each channel of a camera.
struct PhotographedSeries {
  /// Names of the channels: R, G and B first, then others in the order of the file.
  std::vector<std::string> channels;
  std::vector<ExposureSeries> series;  ///< One per channel; patches and times are those of the listing.
  FullScale full_scale = {};           ///< Value of the photographs at code 1.
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
/// Returns nothing after an error in `diagnostics`: a malformed listing, unequal photographs, and values,
/// regions or a `full_scale` that do not fit them. Warns if a region shows that the camera clips below
/// `full_scale`. Throws as `read_raw_image`. `inputs`, unless null, records all files and limits their
/// memory.
[[nodiscard]] std::optional<PhotographedSeries> read_series(const std::filesystem::path& path,
                                                            Diagnostics& diagnostics,
                                                            Inputs* inputs = nullptr);

}  // namespace abbe
