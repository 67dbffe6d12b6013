#pragma once

#include "io/image.h"

namespace abbe {

/// The Stokes vectors that channels behind polarisers of three angles or more tell, by least squares: for
/// each group of channels of one response, C being the name of the first of them, planes C (what it would
/// count of such light unpolarised), S1.C, S2.C, and S3.C, which no linear polariser tells and is 0. The
/// channels of a mosaic are interpolated before. No planes of a film that does not tell enough.
[[nodiscard]] Image stokes_of_polarisers(const Image& film);

}  // namespace abbe
