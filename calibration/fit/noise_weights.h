#pragma once

#include <span>
#include <vector>

#include "calibration/chart/patches.h"

namespace abbe {

/// Weights of noisy patches in the fit of a correction: t^2/(t^2 + s^2).
/// - s is the standard deviation in CIEDE2000 due to the noise of the patch's values.
/// - t is the mean colour difference under the white-preserving least-squares matrix with these weights: the
///   error that the camera makes without noise too.
///
/// Patches with s well below t have nearly equal weights. A far noisier patch has the inverse of its variance
/// as weight, which is best for independent errors of both kinds [DerSimonian1986, eq. 2]. Weights are in (0,
/// 1], and 1 if t is 0. `deviations` are those of the balanced values, one per patch. Throws Error{input} if
/// the patches do not determine the matrix.
[[nodiscard]] std::vector<double> noise_weights(const PatchColors& colors, std::span<const Raw> deviations);

}  // namespace abbe
