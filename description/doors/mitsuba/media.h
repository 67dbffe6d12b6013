#pragma once

#include "description/doors/mitsuba/object.h"

namespace abbe::doors::mitsuba {

/// Homogeneous matter; other matter is noted and left empty.
[[nodiscard]] spec::Medium medium_of(const Object& medium, const World& world);

}  // namespace abbe::doors::mitsuba
