#pragma once

#include <string>

#include "calibration/judge/color_rendering.h"

namespace abbe {

/// The colour vector graphic of [TM30, sec. 4.7] as an SVG document: arrows from the mean colours of the 16
/// bins of hue under the reference, drawn on a circle, to those under the light, R_f and R_g beside them.
/// Bins without samples are left out, and R_g is "-" then.
[[nodiscard]] std::string color_vector_graphic(const ColorFidelity& fidelity, const std::string& title);

}  // namespace abbe
