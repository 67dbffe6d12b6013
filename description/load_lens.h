#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "io/diagnostics.h"
#include "io/inputs.h"
#include "lens/system.h"

namespace abbe {

/// Reads a lens: a file of `data/lens` by its name, a prescription as `.json`, a sequential lens of Zemax as
/// `.zmx`, or a table of radius, thickness, index and diameter as pbrt reads it, as `.dat`. What is wrong is
/// reported, at its place in the file, and a name that is none at `where`, if it has been told anywhere;
/// nothing then. `inputs` learns of every file that is read. With `wavelengths_nm` it is looked at at these
/// in place of its own, the middle one being the primary, its stop and image set at its own.
[[nodiscard]] std::optional<lens::System> load_lens(const std::string& name, Diagnostics& diagnostics,
                                                    Inputs* inputs = nullptr,
                                                    const SourcePosition& where = {},
                                                    const std::vector<double>& wavelengths_nm = {});

/// The lenses of `data/lens`, sorted.
[[nodiscard]] std::vector<std::string> lens_names();

}  // namespace abbe
