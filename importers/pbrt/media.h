#pragma once

#include <string>

#include "importers/pbrt/import_state.h"

namespace abbe::importers::pbrt {

/// Converts the homogeneous medium called `name`; its coefficients are in 1/m. Reports an unknown name at
/// `where` to `state.importer.diagnostics`. Other types of medium are noted. Both become empty, without
/// absorption and scattering. Throws Error{resource} if the memory limit of `state.importer.inputs` is
/// exceeded.
[[nodiscard]] spec::Medium medium_of(const std::string& name, const SourcePosition& where,
                                     ImportState& state);

}  // namespace abbe::importers::pbrt
