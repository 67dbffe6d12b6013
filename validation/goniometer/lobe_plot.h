#pragma once

#include <string>

#include "validation/goniometer/measure.h"

namespace abbe {

/// SVG document with a polar plot in the plane of incidence for each angle of `report`, which was measured
/// for `material` with `settings`. The surface normal points up and the beam comes from the left. The radius
/// of a curve is the square root of f |cos| [1/sr] in the scattered direction, relative to the largest value
/// of its panel. Each wavelength has a curve. A thick line marks a delta direction at the first wavelength;
/// its length is the square root of the fraction of power. A swatch below shows the colour of all reflected
/// light. `title` is escaped.
[[nodiscard]] std::string lobe_plot(const Material& material, const GoniometerSettings& settings,
                                    const GoniometerReport& report, const std::string& title);

}  // namespace abbe
