#pragma once

#include <string>
#include <vector>

#include "calibration/calibration_case.h"
#include "calibration/characterisation.h"
#include "cli/answer.h"

namespace abbe::cli {

[[nodiscard]] Json json_of(const ChannelResponse& response);
/// Table in plain text with a line per channel.
[[nodiscard]] std::string table_of(const std::vector<ChannelResponse>& responses);
/// Responses as CSV: the code, then each channel's linear exposure with its 95 % interval.
[[nodiscard]] std::string csv_of(const std::vector<ChannelResponse>& responses, const std::string& source);

[[nodiscard]] Json json_of(const CalibrationCase& one);
/// Matrices of DNG for the coolest and warmest of several illuminants, with the quality of interpolated
/// matrices for the others. Null for a single illuminant and for corrections that are not matrices.
[[nodiscard]] Json dng_json(const std::vector<CalibrationCase>& cases);
/// Tables of a calibration in plain text: responses, then CIEDE2000 of every patch.
[[nodiscard]] std::string table_of(const CalibrationCase& one);

[[nodiscard]] Json json_of(const std::vector<CameraQuality>& all);
/// Table in plain text with a line per camera and one of medians.
[[nodiscard]] std::string table_of(const std::vector<CameraQuality>& all);

}  // namespace abbe::cli
