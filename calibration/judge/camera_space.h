#pragma once

#include <array>
#include <span>

#include "sensor/response/channel.h"

namespace abbe {

/// How near a camera comes to the condition of Luther: that its channels be linear combinations of the
/// colour-matching functions, so that no matrix errs.
struct CameraSpace {
  /// The Vora value, 1 for a camera that meets the condition, 0 for one that sees nothing of it: the mean
  /// squared cosine of the angles between the spaces spanned by the channels and by the CIE 1931
  /// colour-matching functions, trace(P_A P_B)/3 of their projections [Vora1993, eq. 15].
  double vora = 0;
  /// What the channels cannot make of x, y and z: the norm of what is left of each by the best linear
  /// combination, as a share of its own.
  std::array<double, 3> luther{};
};

/// Both from 1 nm samples of the energy responses over the range of colorimetric sums. Throws Error{usage}
/// for fewer than three channels.
[[nodiscard]] CameraSpace camera_space(std::span<const Channel> channels);

}  // namespace abbe
