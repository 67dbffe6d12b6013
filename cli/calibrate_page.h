#pragma once

#include <string>
#include <vector>

#include "cli/calibrate_report.h"
#include "sensor/response/channel.h"

namespace abbe::cli {

/// What a page tells of a sensor besides its colours: answers of `abbe transfer` and `abbe mtf`; null:
/// nothing.
struct BenchAnswers {
  Json transfer;
  Json mtf;
};

/// Calibrations as one page of HTML: the camera's curves and how near they come to an observer (when
/// `channels` are known), noise, range and modulation transfer as they were measured, and under each light
/// the patches as they are, balanced only, and corrected, the distribution of their differences, and the
/// figures.
[[nodiscard]] std::string page_of(const std::vector<CalibrationCase>& cases,
                                  const std::vector<Channel>& channels, const BenchAnswers& bench);

}  // namespace abbe::cli
