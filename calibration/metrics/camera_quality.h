#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "calibration/fit/correction.h"
#include "calibration/fit/resampling.h"
#include "sensor/response/channel.h"

namespace abbe {

/// Best possible colour correction of one measured camera on a chart, from integrated colours alone: without
/// noise, flare and rounding. All errors are CIEDE2000.
struct CameraQuality {
  std::string camera;            ///< Name in `data/camera`.
  PatchErrors least_squares;     ///< Errors of the white-preserving least-squares matrix.
  PatchErrors matrix;            ///< Errors of the matrix that minimises the mean.
  PatchErrors matrix_unseen;     ///< Cross-validation errors of that matrix, leaving one patch out at a time.
  PatchErrors root;              ///< Errors of the root polynomial of degree 2.
  PatchErrors root_unseen;       ///< Cross-validation errors of the root polynomial.
  double sensitivity_index = 0;  ///< Result of the function `sensitivity_index`.
};

/// The quality of every shipped camera of three channels, in the order of their names, under a light on any
/// scale. Throws Error{usage} if the chart has too few patches for the root polynomial (24), and otherwise as
/// `integrate` and `fit_correction`.
[[nodiscard]] std::vector<CameraQuality> all_camera_qualities(const Chart& chart, const Curve& light);

/// Colour accuracy of three channels: 100 - 5.5 times a mean distance in L*a*b*, at most 100 and possibly
/// negative. The mean is over the 18 chromatic patches of the ColorChecker (ISO 17321-1 spectra) in D55,
/// under the white-preserving matrix that minimises it. It has the form of the sensitivity metamerism index
/// [ISO17321] but not its value. The standard prescribes another training and tables of measured raw data.
/// Throws Error{usage} for another number of channels. Throws Error{input} if a channel receives nothing from
/// D55, or if the channels do not distinguish colours.
[[nodiscard]] double sensitivity_index(const std::vector<Channel>& channels);

/// Deviation of a camera from the Luther condition. A camera meets it if its channels are linear combinations
/// of the colour-matching functions; then a matrix corrects all colours exactly.
struct CameraSpace {
  /// Vora value: 1 for a camera that meets the condition, 0 for channels orthogonal to it. It is trace(P_A
  /// P_B)/3 of the projections on the spaces of the channels and of the CIE 1931 colour-matching functions:
  /// the mean squared cosine of the angles between them [Vora1993, eq. 15].
  double vora = 0;
  /// Relative error of x, y and z, in [0, 1]: the norm of the residual of the best linear combination of the
  /// channels, divided by the norm of the function.
  std::array<double, 3> luther{};
};

/// Computes both from 1 nm samples of the energy responses over the range of colorimetric sums. Throws
/// Error{usage} for fewer than three channels.
[[nodiscard]] CameraSpace camera_space(std::span<const Channel> channels);

}  // namespace abbe
