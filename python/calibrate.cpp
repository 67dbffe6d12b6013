#include <filesystem>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "calibration/camera_calibration.h"
#include "python/arguments.h"
#include "python/errors.h"
#include "python/gil.h"
#include "python/module.h"
#include "python/numbers.h"

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

// Arrays by channel. The rows are codes; the columns are the code as a fraction of the largest, the exposure,
// and the bounds of its 95 % interval.
py::dict curves_of(const std::vector<ChannelResponse>& responses) {
  py::dict curves;
  for (const ChannelResponse& response : responses) {
    const std::vector<double>& linear = response.fit.linear;
    std::vector<std::array<double, 4>> rows;
    for (std::size_t i = 0; i < linear.size(); ++i) {
      const auto [low, high] = bounds_95(response.fit, i);
      const double code = static_cast<double>(i) / static_cast<double>(linear.size() - 1);
      rows.push_back({code, linear[i], low, high});
    }
    curves[py::str(response.channel)] = py::array(py::cast(rows));
  }
  return curves;
}

// The results by the names that the docstring of `calibrate` describes.
py::dict dict_of(const CameraCalibration& made) {
  py::dict result;
  result["patches"] = made.colors.names;
  result["dE00"] = py::array(py::cast(made.correction.errors.delta_e));
  result["dE00_mean"] = made.correction.errors.mean;
  result["dE00_max"] = made.correction.errors.max;
  result["dE00_unseen_mean"] = made.unseen.mean;
  if (made.profile.correction.model == CorrectionModel::linear)
    result["to_xyz_d65"] = matrix_of(made.profile);
  result["gains"] = made.profile.gains;
  py::dict errors;
  for (const ChannelResponse& response : made.responses)
    errors[py::str(response.channel)] = response.max_error;
  result["response_max_error"] = errors;
  result["responses"] = curves_of(made.responses);
  return result;
}

// Throws if an argument has no effect because of another one, as the command does for its options.
void require_effect(const CalibrationSource& source, bool is_measured, bool has_bits) {
  if (is_measured && !source.planted_response.empty())
    refuse_argument("response", "is planted into a simulated camera, not into a measured one");
  if (is_measured && has_bits)
    refuse_argument("bits", "are those of a simulated camera, not of a measured one");
  if (!source.series.empty() && !is_measured)
    refuse_argument("series", "needs measured; recover_response returns the curves alone");
  if (source.camera.empty() && (!is_measured || !source.training.empty()))
    refuse_argument("camera", "is needed, unless measured is given without training");
  if (!source.camera.empty() && is_measured && source.training.empty())
    refuse_argument("camera", "is allowed with measured only for training, to which its curves apply");
  if (source.camera.empty() && source.camera_response)
    refuse_argument("camera_response", "needs camera, to whose curves it applies");
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
    refuse_argument("correction", "expected {} or auto (got {})", fmt::join(kCorrectionNames, ", "),
                    correction);
  std::optional<CalibrationCase> made;
  Diagnostics diagnostics;
  {
    const GilReleased released;
    Inputs photographs;
    made = measured ? measured_calibration(source, illuminant, photographs, diagnostics)
                    : simulated_calibration(source, illuminant, diagnostics);
  }
  check(diagnostics);
  return dict_of(made->result);
}

py::dict responses_of(const fs::path& series) {
  RecoveredResponses recovered;
  Diagnostics diagnostics;
  {
    const GilReleased released;
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
      "Calibrates a camera on a chart under an illuminant, as `abbe calibrate` does. It fits the "
      "white-preserving correction with the least mean CIEDE2000.\n\n`camera` is a camera with known curves. "
      "It photographs the chart with `bits` bits, 12 by default, linearly or through a planted response "
      "(\"linear\", \"gamma:G\" or \"s-curve\"), which is then recovered without knowledge of it. Instead, "
      "`measured` is a table of a real camera's values of the chart. `series` are photographs of the same "
      "camera at known exposure times; the response recovered from them linearises the values. `training` "
      "names reflectances that replace the chart in the fit. Their camera values follow from the curves of "
      "`camera`, which is given with `measured` only for this purpose. `correction` is \"matrix\", "
      "\"root-polynomial-2\", \"root-polynomial-3\" or \"auto\". `camera_response` states the quantity that "
      "the camera's curves multiply, \"energy\" or \"quantum\". Without it, columns named QE are quantum "
      "efficiencies, and all others are responses to energy.\n\nReturns a dict: CIEDE2000 of each patch, its "
      "mean and maximum, and its mean over patches left out of the fit; the gains that balance white; for a "
      "matrix also the matrix from linear camera values to XYZ relative to D65; for each recovered response "
      "its curve, as from `recover_response`, and, if it was planted, its maximum error as a fraction of "
      "full scale. Raises InputError for an unknown name and for unusable files, and UsageError for "
      "arguments that other arguments make ineffective.");
  module.def(
      "recover_response", responses_of, py::arg("series"),
      "Recovers the response of a real camera's channels from photographs at known exposure times, as `abbe "
      "calibrate --series` does.\n\nReturns a dict of arrays by channel with four columns: the code as a "
      "fraction of the largest, the exposure (1 at full scale), and the bounds of its 95 % interval. Raises "
      "InputError for files that cannot be read, and for a series that determines no curve.");
}

}  // namespace abbe::python
