#pragma once

#include <string>
#include <vector>

#include "description/importers/mitsuba/materials.h"
#include "description/importers/shared/placement.h"

namespace abbe::importers::mitsuba {

/// Adds a shape to `shapes`, or an object for a shape group. Reports unknown types and missing files; notes
/// what Abbe cannot represent.
void add_shape(const Object& shape, ShapeOwner owner, std::vector<spec::Shape>& shapes, Materials& materials,
               const ImportState& state);

}  // namespace abbe::importers::mitsuba
