#pragma once

#include <string>

#include "validation/lens/figures.h"

namespace abbe {

/// SVG document with the section of a lens in the plane x = 0. It shows the glasses, the stop and the image.
/// For each field it shows five rays in the plane of the section at the primary wavelength: the chief ray,
/// the two rays through the edges of the stop, and two between them. Surfaces without a clear aperture are
/// drawn as far out as the rays hit them.
[[nodiscard]] std::string lens_drawing(const LensFigures& figures);

}  // namespace abbe
