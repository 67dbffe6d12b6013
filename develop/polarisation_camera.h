#pragma once

#include "io/image.h"

namespace abbe {

/// Stokes vectors from channels behind linear polarisers at three or more angles, by least squares. Channels
/// of the same response form a group, named after its first channel C. The result has planes C (the value for
/// the same light unpolarised), S1.C and S2.C. S3.C, which linear polarisers cannot measure, is 0. A mosaic
/// is demosaicked first. Groups whose angles do not suffice have no planes.
[[nodiscard]] Image stokes_of_polarisers(const Image& film);

}  // namespace abbe
