#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "io/diagnostics.h"
#include "io/inputs.h"
#include "lens/system.h"

namespace abbe {

/// Reads and builds a lens, which `name` gives as one of:
/// - the name of a file of `data/lens`;
/// - a prescription as `.json`;
/// - a sequential lens of Zemax as `.zmx`;
/// - a table of radius, thickness, index and diameter in pbrt's format as `.dat`.
/// Errors are reported at their position in the file; an unknown name at `where`, if that is known. Returns
/// nothing after an error. `inputs` records every file that is read. `wavelengths_nm`, if given, replace the
/// lens's own, with the median one as the primary. Stop and image are still set at the lens's own primary
/// wavelength.
[[nodiscard]] std::optional<lens::System> load_lens(const std::string& name, Diagnostics& diagnostics,
                                                    Inputs* inputs = nullptr,
                                                    const SourcePosition& where = {},
                                                    const std::vector<double>& wavelengths_nm = {});

/// The names of the lenses of `data/lens`, sorted.
[[nodiscard]] std::vector<std::string> lens_names();

}  // namespace abbe
