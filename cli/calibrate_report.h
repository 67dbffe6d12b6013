#pragma once

#include <string>
#include <vector>

#include "calibration/calibration_case.h"
#include "calibration/characterisation.h"
#include "cli/answer.h"

namespace abbe::cli {

[[nodiscard]] Json json_of(const ChannelResponse& response);
/// A line for each channel, under its headings.
[[nodiscard]] std::string table_of(const std::vector<ChannelResponse>& responses);
/// The curves as a table: code, then each channel's linear exposure with its 95 % interval.
[[nodiscard]] std::string csv_of(const std::vector<ChannelResponse>& responses, const std::string& source);

[[nodiscard]] Json json_of(const CalibrationCase& one);
/// The matrices of DNG for the coolest and warmest of several lights, with how well what lies between them
/// suits the others; null for one light, and for corrections that are no matrices.
[[nodiscard]] Json dng_json(const std::vector<CalibrationCase>& cases);
/// A calibration as tables for reading: responses, then CIEDE2000 of every patch.
[[nodiscard]] std::string table_of(const CalibrationCase& one);

[[nodiscard]] Json json_of(const std::vector<CameraQuality>& all);
/// A line for each camera and one of medians.
[[nodiscard]] std::string table_of(const std::vector<CameraQuality>& all);

}  // namespace abbe::cli
