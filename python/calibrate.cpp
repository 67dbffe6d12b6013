#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "calibration/camera_calibration.h"
#include "python/develop.h"
#include "python/errors.h"
#include "spectral/library.h"

namespace abbe::python {
namespace {

namespace py = pybind11;

py::array_t<double> matrix_of(const CameraProfile& profile) {
  const Matrix3 matrix = matrix_to_xyz_d65(profile);
  py::array_t<double> rows({3, 3});
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) rows.mutable_at(i, j) = matrix[i][j];
  return rows;
}

py::dict told_of(const CameraCalibration& made) {
  py::dict told;
  told["patches"] = made.patches;
  told["dE00"] = py::array(py::cast(made.correction.errors.delta_e));
  told["dE00_mean"] = made.correction.errors.mean;
  told["dE00_max"] = made.correction.errors.max;
  told["dE00_unseen_mean"] = made.unseen.mean;
  told["to_xyz_d65"] = matrix_of(made.profile);
  py::dict errors;
  for (const ChannelResponse& response : made.responses)
    errors[py::str(response.channel)] = response.max_error;
  told["response_max_error"] = errors;
  return told;
}

py::dict calibrate(const std::string& camera, const std::string& illuminant, const std::string& chart,
                   const std::string& response, int bits) {
  Diagnostics diagnostics;
  const auto channels = load_camera(camera, {}, diagnostics);
  const auto light = load_illuminant(illuminant, {}, diagnostics);
  const auto patches = load_chart(chart, {}, diagnostics);
  check(diagnostics);
  std::optional<CameraCalibration> made;
  {
    const py::gil_scoped_release released;
    made = calibrate_camera({camera, illuminant, response, bits, *channels, light->curve, *patches});
  }
  return told_of(*made);
}

}  // namespace

void add_calibrate(py::module_& module) {
  module.def(
      "calibrate", calibrate, py::arg("camera"), py::arg("illuminant") = "D65", py::kw_only(),
      py::arg("chart") = "colorchecker24_babelcolor_average", py::arg("response") = "", py::arg("bits") = 12,
      "Calibrates a measured camera on a chart under an illuminant, as `abbe calibrate` does: the chart is "
      "photographed at so many bits by a linear camera, or through a planted response (\"linear\", "
      "\"gamma:G\" "
      "or \"s-curve\") that is recovered without knowing it, and the white-preserving matrix with the least "
      "mean "
      "CIEDE2000 "
      "is fitted.\n\nReturns a dict: CIEDE2000 of each patch, its mean and largest, its mean over patches "
      "that "
      "the fit has not seen, the largest error of each recovered response as a share of full scale, and the "
      "matrix from linear camera values to XYZ relative to D65. Raises InputError for an unknown name.");
}

}  // namespace abbe::python
