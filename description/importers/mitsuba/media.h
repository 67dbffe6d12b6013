#pragma once

#include "description/importers/mitsuba/object.h"

namespace abbe::importers::mitsuba {

/// Converts a homogeneous medium. Other media are noted and become empty.
[[nodiscard]] spec::Medium medium_of(const Object& medium, const ImportState& state);

}  // namespace abbe::importers::mitsuba
