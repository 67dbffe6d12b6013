#pragma once

#include <string>
#include <vector>

#include "cli/calibrate_report.h"
#include "sensor/response/channel.h"

namespace abbe::cli {

/// Answers of `abbe transfer` and `abbe mtf` for a page, as `read_answer` returns them; null if absent.
struct MeasurementAnswers {
  Json transfer;
  Json mtf;
};

/// Self-contained HTML page of calibrations of one camera. It shows:
/// - the camera's spectral responses and their fit to an observer, if there are three `channels`;
/// - the measured noise, dynamic range and modulation transfer, if known;
/// - the reference patches under each illuminant, with white balance only, and corrected;
/// - the distribution of their colour differences, and all figures.
[[nodiscard]] std::string page_of(const std::vector<CalibrationCase>& cases,
                                  const std::vector<Channel>& channels,
                                  const MeasurementAnswers& measurements);

}  // namespace abbe::cli
