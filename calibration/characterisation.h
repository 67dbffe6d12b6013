#pragma once

#include <array>
#include <string>
#include <vector>

#include "calibration/fit/correction_fit.h"
#include "calibration/fit/resampling.h"
#include "sensor/response/channel.h"

namespace abbe {

/// How well one measured camera can be corrected on a chart, from integrated colours alone: no noise, no
/// flare, no rounding. All errors are CIEDE2000.
struct CameraQuality {
  std::string camera;
  PatchErrors least_squares;  ///< Of the white-preserving least-squares matrix.
  PatchErrors matrix;         ///< Of the matrix that minimises the mean.
  PatchErrors matrix_unseen;  ///< Of that, each patch left out of the fit that shows it.
  PatchErrors root;           ///< Of the root polynomial of degree 2.
  PatchErrors root_unseen;
  double sensitivity_index = 0;  ///< See `sensitivity_index`.
};

/// The quality of every shipped camera of three channels, in the order of their names.
[[nodiscard]] std::vector<CameraQuality> all_camera_qualities(const Chart& chart, const Curve& light);

/// 100 - 5.5 times the mean distance in L*a*b* over the 18 chromatic patches of the ColorChecker (ISO 17321-1
/// spectra) in D55, under the white-preserving matrix that minimises it: the form of the sensitivity
/// metamerism index [ISO17321], but not its figure, since the standard's own training and its tables of a
/// makers' measured raw data are others.
[[nodiscard]] double sensitivity_index(const std::vector<Channel>& channels);

}  // namespace abbe
