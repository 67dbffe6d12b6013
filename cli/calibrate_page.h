#pragma once

#include <string>
#include <vector>

#include "cli/calibrate_report.h"
#include "sensor/response/channel.h"

namespace abbe::cli {

/// Answers of `abbe transfer` and `abbe mtf` for a page; null if absent.
struct MeasurementAnswers {
  Json transfer;
  Json mtf;
};

/// HTML page of calibrations. It shows:
/// - the camera's spectral responses and their fit to an observer, if `channels` are known;
/// - the measured noise, dynamic range and modulation transfer;
/// - the reference patches under each illuminant, with white balance only, and corrected;
/// - the distribution of their colour differences, and all figures.
[[nodiscard]] std::string page_of(const std::vector<CalibrationCase>& cases,
                                  const std::vector<Channel>& channels,
                                  const MeasurementAnswers& measurements);

}  // namespace abbe::cli
