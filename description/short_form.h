#pragma once

#include "io/json.h"

namespace abbe::description {

/// Puts objects in the place of surfaces that are written as [radius, thickness], [radius, thickness, glass]
/// or [radius, thickness, glass, aperture], null standing for what is not said. Reports lists of other
/// lengths.
void expand_short_surfaces(JsonValue& lens, Diagnostics& diagnostics);

}  // namespace abbe::description
