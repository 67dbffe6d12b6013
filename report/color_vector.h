#pragma once

#include <string>

#include "calibration/metrics/color_rendering.h"

namespace abbe {

/// Colour vector graphic of [TM30, sec. 4.7] as an SVG document. An arrow for each of the 16 hue bins points
/// from the mean colour under the reference, on a circle, to that under the light. R_f and R_g are printed in
/// the corners. Bins without samples are omitted; R_g is "-" if it is NaN. `title` is escaped.
[[nodiscard]] std::string color_vector_graphic(const ColorFidelity& fidelity, const std::string& title);

}  // namespace abbe
