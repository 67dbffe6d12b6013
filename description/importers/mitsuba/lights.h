#pragma once

#include "description/importers/mitsuba/object.h"

namespace abbe::importers::mitsuba {

/// The emission of a surface with an area light.
[[nodiscard]] spec::Emission area_emission(const Object& light, const ImportState& state);

/// Adds a light that is not an area light. Reports an unknown type; notes what Abbe cannot represent.
void add_light(const Object& light, const ImportState& state);

}  // namespace abbe::importers::mitsuba
