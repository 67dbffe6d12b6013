#pragma once

#include "io/image.h"

namespace abbe {

/// Stokes vectors from channels behind linear polarisers at three or more angles, by least squares. Channels
/// of the same response form a group, named after its first channel C. The result has planes C (the value of
/// that channel for the same light unpolarised), S1.C and S2.C, in the film's unit. It has no S3.C, which
/// linear polarisers cannot measure. A mosaic is demosaicked first. Groups whose angles do not suffice have
/// no planes; a film without polarisers gives no planes at all.
[[nodiscard]] Image stokes_of_polarisers(const Image& film);

}  // namespace abbe
