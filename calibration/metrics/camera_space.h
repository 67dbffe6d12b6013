#pragma once

#include <array>
#include <span>

#include "sensor/response/channel.h"

namespace abbe {

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
