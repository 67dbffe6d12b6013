#pragma once

#include "description/doors/mitsuba/object.h"

namespace abbe::doors::mitsuba {

/// What a surface with an area light sends out.
[[nodiscard]] spec::Emission area_emission(const Object& light, const World& world);

/// Adds a light that is no surface. Reports an unknown type; notes what has no counterpart.
void add_light(const Object& light, const World& world);

}  // namespace abbe::doors::mitsuba
