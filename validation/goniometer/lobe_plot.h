#pragma once

#include <string>

#include "validation/goniometer/measure.h"

namespace abbe {

/// A polar plot for each angle as one SVG document: in the plane of incidence, the radius is the square root
/// of f cos over the largest of its panel, one line per wavelength; an arrow for what goes in a single
/// direction, as long as the root of its share. Below, the colour of all that is reflected.
[[nodiscard]] std::string lobe_plot(const Material& material, const GoniometerSettings& settings,
                                    const GoniometerReport& report, const std::string& title);

}  // namespace abbe
