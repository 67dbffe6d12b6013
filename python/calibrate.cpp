#include <filesystem>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "calibration/calibration_case.h"
#include "python/develop.h"
#include "python/errors.h"
#include "python/lock.h"
#include "python/numbers.h"
#include "python/query.h"

namespace abbe::python {
namespace {

namespace fs = std::filesystem;
namespace py = pybind11;

py::array_t<double> matrix_of(const CameraProfile& profile) {
  const Matrix3 matrix = matrix_to_xyz_d65(profile);
  py::array_t<double> rows({3, 3});
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) rows.mutable_at(i, j) = matrix[i][j];
  return rows;
}

// Of each channel, over codes as shares of the largest, exposure and the bounds of its 95 % interval.
py::dict curves_of(const std::vector<ChannelResponse>& responses) {
  py::dict curves;
  for (const ChannelResponse& response : responses) {
    const std::vector<double>& linear = response.fit.linear;
    py::array_t<double> rows({linear.size(), std::size_t{4}});
    auto row = rows.mutable_unchecked<2>();
    for (std::size_t i = 0; i < linear.size(); ++i) {
      const auto [low, high] = bounds_95(response.fit, i);
      const std::array<double, 4> values{static_cast<double>(i) / static_cast<double>(linear.size() - 1),
                                         linear[i], low, high};
      for (std::size_t k = 0; k < 4; ++k)
        row(static_cast<py::ssize_t>(i), static_cast<py::ssize_t>(k)) = values[k];
    }
    curves[py::str(response.channel)] = rows;
  }
  return curves;
}

py::dict told_of(const CameraCalibration& made) {
  py::dict told;
  told["patches"] = made.patches;
  told["dE00"] = py::array(py::cast(made.correction.errors.delta_e));
  told["dE00_mean"] = made.correction.errors.mean;
  told["dE00_max"] = made.correction.errors.max;
  told["dE00_unseen_mean"] = made.unseen.mean;
  if (made.profile.correction.model == CorrectionModel::linear) told["to_xyz_d65"] = matrix_of(made.profile);
  told["gains"] = made.profile.gains;
  py::dict errors;
  for (const ChannelResponse& response : made.responses)
    errors[py::str(response.channel)] = response.max_error;
  told["response_max_error"] = errors;
  told["responses"] = curves_of(made.responses);
  return told;
}

// Arguments beside which others would have no effect are refused, as options are by the command.
void require_effect(const CalibrationSource& source, bool is_measured, bool has_bits) {
  const auto refuse = [](const char* argument, const char* why) {
    throw Error(ErrorCode::usage, argument, why);
  };
  if (is_measured && !source.planted_response.empty())
    refuse("response", "is planted into a simulated camera, not into a measured one");
  if (is_measured && has_bits) refuse("bits", "are those of a simulated camera, not of a measured one");
  if (!source.series.empty() && !is_measured)
    refuse("series", "needs measured (its curves alone are those of recover_response)");
  if (source.camera.empty() && (!is_measured || !source.training.empty()))
    refuse("camera", "is needed, unless measured is given without training");
  if (!source.camera.empty() && is_measured && source.training.empty())
    refuse("camera", "is allowed with measured only for training, which is seen through its curves");
  if (source.camera.empty() && source.camera_response)
    refuse("camera_response", "needs camera, whose curves it speaks of");
}

py::dict calibrate(const std::string& camera, const std::string& illuminant, const std::string& chart,
                   const std::string& response, std::optional<Whole<int>> bits,
                   const std::optional<fs::path>& measured, const std::optional<fs::path>& series,
                   const std::string& training, const std::string& correction,
                   const std::string& camera_response) {
  CalibrationSource source;
  source.camera = camera;
  source.measured = measured.value_or("");
  source.series = series.value_or("");
  source.chart = chart;
  source.training = training;
  source.planted_response = response;
  source.bits = bits ? *bits : source.bits;
  source.camera_response = response_of("camera_response", camera_response);
  require_effect(source, measured.has_value(), bits.has_value());
  if (!choose_correction(source.how, correction))
    throw Error(ErrorCode::usage, "correction",
                fmt::format("expected {} or auto (got {})", fmt::join(kCorrectionNames, ", "), correction));
  std::optional<CalibrationCase> made;
  Diagnostics diagnostics;
  {
    const Released released;
    Inputs photographs;
    made = measured ? measured_calibration(source, illuminant, photographs, diagnostics)
                    : simulated_calibration(source, illuminant, diagnostics);
  }
  check(diagnostics);
  return told_of(made->result);
}

py::dict responses_of(const fs::path& series) {
  RecoveredResponses recovered;
  Diagnostics diagnostics;
  {
    const Released released;
    Inputs photographs;
    recovered = recover_responses(series, photographs, diagnostics);
  }
  check(diagnostics);
  return curves_of(recovered.channels);
}

}  // namespace

void add_calibrate(py::module_& module) {
  module.def(
      "calibrate", calibrate, py::arg("camera") = "", py::arg("illuminant") = "D65", py::kw_only(),
      py::arg("chart") = "colorchecker24_babelcolor_average", py::arg("response") = "",
      py::arg("bits") = py::none(), py::arg("measured") = py::none(), py::arg("series") = py::none(),
      py::arg("training") = "", py::arg("correction") = "matrix", py::arg("camera_response") = "",
      "Calibrates a camera on a chart under an illuminant, as `abbe calibrate` does: the white-preserving "
      "correction with the least mean CIEDE2000 is fitted.\n\n`camera` is a camera whose curves are known: "
      "the "
      "chart is photographed at so many `bits`, 12 by default, by a linear camera, or through a planted "
      "response (\"linear\", "
      "\"gamma:G\" or \"s-curve\") that is recovered without knowing it. Or `measured` is a table of a real "
      "camera's values of the chart, and `series` its photographs at known exposure times, by whose curves "
      "these "
      "are made linear. `training` names reflectances to fit to instead, seen through `camera`, which is "
      "given beside `measured` "
      "for that alone. `correction` "
      "is "
      "\"matrix\", \"root-polynomial-2\", \"root-polynomial-3\" or \"auto\". `camera_response` says what the "
      "camera's curves multiply, \"energy\" or \"quantum\"; without it those of columns named QE are quantum "
      "efficiencies, and all others responses to energy.\n\nReturns a dict: CIEDE2000 of "
      "each "
      "patch, its mean and largest, its mean over patches that the fit has not seen, the gains that balance "
      "white, "
      "of a matrix that from linear camera values to XYZ relative to D65, and of each "
      "recovered response its curve, as `recover_response` has it, and the largest error where it was "
      "planted, as a "
      "share of full scale. Raises InputError for an unknown name and for files that cannot be used, "
      "UsageError for "
      "arguments that have no effect beside others.");
  module.def(
      "recover_response", responses_of, py::arg("series"),
      "Recovers the response of a real camera's channels from photographs at known exposure times, as `abbe "
      "calibrate --series` does.\n\nReturns a dict by channel of arrays with four columns: code, as a share "
      "of "
      "the largest; exposure, 1 at full scale; and the bounds of its 95 % interval. Raises InputError for "
      "files "
      "that cannot be read, and for a series that determines no curve.");
}

}  // namespace abbe::python
