#pragma once

#include "io/image.h"
#include "validation/goniometer/measure.h"

namespace abbe {

/// Map of the scattered light as display code values, with one column per angle of incidence.
/// The upper disc of a column is the hemisphere of the incident beam and the lower disc the other one. Each
/// disc is an equal-area projection along the normal; the beam comes from the left. Colours are those of f
/// cos under the illuminant, relative to the largest channel of the column. Delta directions are not drawn.
[[nodiscard]] Image lobe_map(const Material& material, const GoniometerSettings& settings);

}  // namespace abbe
