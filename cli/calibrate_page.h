#pragma once

#include <string>
#include <vector>

#include "cli/calibrate_report.h"
#include "sensor/response/channel.h"

namespace abbe::cli {

/// Calibrations as one page of HTML: the camera's curves and how near they come to an observer (when
/// `channels` are known), and under each light the patches as they are, balanced only, and corrected, the
/// distribution of their differences, and the figures.
[[nodiscard]] std::string page_of(const std::vector<CalibrationCase>& cases,
                                  const std::vector<Channel>& channels);

}  // namespace abbe::cli
