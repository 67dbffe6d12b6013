#pragma once

#include "io/image.h"
#include "validation/goniometer/measure.h"

namespace abbe {

/// Where the light of each angle goes, as display code values: one column per angle, above the side the beam
/// comes from and below the other, each hemisphere as a disc seen along the normal (equal areas for equal
/// solid angles, the beam from the left). Colours are those of f cos under the illuminant, over the largest
/// channel of the column; single directions do not show.
[[nodiscard]] Image lobe_map(const Material& material, const GoniometerSettings& settings);

}  // namespace abbe
