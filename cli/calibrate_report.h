#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calibration/camera_calibration.h"
#include "calibration/metrics/camera_quality.h"
#include "cli/answer.h"
#include "io/inputs.h"
#include "sensor/response/channel.h"

namespace abbe::cli {

/// Figures of a response's fit, without its curve.
[[nodiscard]] Json json_of(const ChannelResponse& response);
/// Table in plain text with a line per channel: errors in % of full scale.
[[nodiscard]] std::string table_of(const std::vector<ChannelResponse>& responses);
/// Responses as CSV: the code, then each channel's linear exposure (1 at full scale) with its 95 % interval.
/// `source` is named in a comment line. There must be at least one response, and all curves must have one
/// size.
[[nodiscard]] std::string csv_of(const std::vector<ChannelResponse>& responses, const std::string& source);

/// All figures of a calibration; colour differences are CIEDE2000 (dE00) and CIE 1976 (dE76).
[[nodiscard]] Json json_of(const CalibrationCase& one);
/// Matrices of DNG for the coolest and warmest of several illuminants, with the quality of interpolated
/// matrices for the others. Null for a single illuminant, and if `dng_light` is empty for one of them, as for
/// a root polynomial.
[[nodiscard]] Json dng_json(const std::vector<CalibrationCase>& cases);
/// Tables of a calibration in plain text: responses, then CIEDE2000 of every patch.
[[nodiscard]] std::string table_of(const CalibrationCase& one);

/// Object with the list `cameras`: means and maxima of the errors of each.
[[nodiscard]] Json json_of(const std::vector<CameraQuality>& all);
/// Table in plain text with a line per camera, of which there must be at least one, and one of medians.
[[nodiscard]] std::string table_of(const std::vector<CameraQuality>& all);

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

/// Colour "#rrggbb" of a channel's line: its own for R, G and B, otherwise one of three by the index `i`.
[[nodiscard]] std::string line_color(const std::string& channel, std::size_t i);

/// Photon-transfer curves as SVG from an answer of `abbe transfer --json`: the measured variance over signal,
/// with the line of each channel's gain. Throws Json::exception for an answer without these lists.
[[nodiscard]] std::string transfer_plot(const Json& answer);

/// Modulation transfer function as SVG from an answer of `abbe mtf --json`. Throws Json::exception for
/// another answer.
[[nodiscard]] std::string mtf_plot(const Json& answer);

/// Reads an answer from a file, which is recorded in `inputs`. Throws Error{input} if the file cannot be read
/// or `plot`, such as `transfer_plot`, cannot draw it.
[[nodiscard]] Json read_answer(const std::filesystem::path& path, std::string (*plot)(const Json&),
                               Inputs& inputs);

}  // namespace abbe::cli
