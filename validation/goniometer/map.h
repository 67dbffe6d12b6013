#pragma once

#include "io/image.h"
#include "validation/goniometer/measure.h"

namespace abbe {

/// Map of the scattered light as an image with the channels R, G and B, sRGB code values in [0, 1]. It has
/// one column of 96 pixels per angle of incidence of `settings` and is 192 pixels high. The upper disc of a
/// column is the hemisphere of the incident beam and the lower disc the other one. Each disc is an equal-area
/// projection along the normal; the beam comes from the left. Colours are those of f |cos| under the
/// illuminant, with the cosine of the scattered direction. Each column is scaled to its largest channel.
/// Delta directions are not drawn.
[[nodiscard]] Image lobe_map(const Material& material, const GoniometerSettings& settings);

}  // namespace abbe
