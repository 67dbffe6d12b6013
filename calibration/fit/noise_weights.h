#pragma once

#include <span>
#include <vector>

#include "calibration/chart/patches.h"

namespace abbe {

/// What noisy patches should count in the fit of a correction: t^2/(t^2 + s^2), s being the standard
/// deviation in CIEDE2000 that the noise of the patch's values brings about and t the mean colour difference
/// under the white-preserving least-squares matrix of these weights, by which the camera errs without noise
/// too. So patches whose noise is below that count alike, and one far noisier counts by the inverse of its
/// variance, as is best for independent errors of both kinds [DerSimonian1986, eq. 2]. `deviations` are those
/// of the balanced values, one a patch.
[[nodiscard]] std::vector<double> noise_weights(const PatchColors& colors, std::span<const Raw> deviations);

}  // namespace abbe
