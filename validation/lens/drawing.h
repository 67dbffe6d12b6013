#pragma once

#include <string>

#include "validation/lens/figures.h"

namespace abbe {

/// The section of a lens in the plane x = 0 as one SVG: glasses, stop, image, the chief ray and the rays
/// through both edges of the stop of every field at the primary wavelength, and a bar of scale. Surfaces
/// without a clear aperture are drawn as far as rays reach.
[[nodiscard]] std::string lens_drawing(const LensFigures& figures);

}  // namespace abbe
