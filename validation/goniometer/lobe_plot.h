#pragma once

#include <string>

#include "validation/goniometer/measure.h"

namespace abbe {

/// SVG document with a polar plot for each angle, in the plane of incidence.
/// The radius of a curve is sqrt(f cos), relative to the largest value of its panel; each wavelength has a
/// curve. An arrow marks a delta direction; its length is the square root of the fraction of power. A swatch
/// below shows the colour of all reflected light.
[[nodiscard]] std::string lobe_plot(const Material& material, const GoniometerSettings& settings,
                                    const GoniometerReport& report, const std::string& title);

}  // namespace abbe
