#pragma once

#include <string>

#include "description/importers/pbrt/import_state.h"

namespace abbe::importers::pbrt {

/// Converts the homogeneous medium called `name`. Reports an unknown name. Other media are noted and become
/// empty.
[[nodiscard]] spec::Medium medium_of(const std::string& name, const SourcePosition& where,
                                     ImportState& state);

}  // namespace abbe::importers::pbrt
