#pragma once

#include "importers/mitsuba/object.h"

namespace abbe::importers::mitsuba {

/// Converts a homogeneous <medium>; its "sigma_t" is in 1/m. Other types of medium are noted and become
/// empty, without absorption and scattering. Unsupported phase functions are noted and become isotropic.
/// Reports malformed properties to `state.importer.diagnostics`. Throws Error{resource} if its memory limit
/// is exceeded.
[[nodiscard]] spec::Medium medium_of(const Object& medium, const ImportState& state);

}  // namespace abbe::importers::mitsuba
