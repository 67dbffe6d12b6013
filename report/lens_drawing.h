#pragma once

#include <string>

#include "report/lens_figures.h"

namespace abbe {

/// SVG document with the section of a lens in the plane x = 0, +z to the right and +y upwards. It shows the
/// glasses, the stop and the image, with a scale bar in mm and the title of the system.
/// Each field has a colour and five rays in the plane of the section at the primary wavelength. They are the
/// chief ray, the two rays through the edges of the stop, and two halfway between them. A ray that does
/// not arrive at the image ends at the last surface that it passes. Fields whose chief ray does not pass the
/// stop have no rays. Surfaces without a clear aperture are drawn 5 % farther out than the rays hit them.
[[nodiscard]] std::string lens_drawing(const LensFigures& figures);

}  // namespace abbe
