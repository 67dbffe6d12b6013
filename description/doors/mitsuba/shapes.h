#pragma once

#include <string>
#include <vector>

#include "description/doors/mitsuba/materials.h"
#include "description/doors/shared/placement.h"

namespace abbe::doors::mitsuba {

/// Adds a shape, or, of a shape group, an object. Reports an unknown type and files that are missing; notes
/// what has no counterpart.
void add_shape(const Object& shape, Among among, std::vector<spec::Shape>& shapes, Materials& materials,
               const World& world);

}  // namespace abbe::doors::mitsuba
