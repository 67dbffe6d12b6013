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
/// File names are relative to the working directory. Errors are reported at their position in the file, and
/// an unknown name at `where`. Returns nothing if `diagnostics` then have an error, also an earlier one. A
/// lens without a title gets its file name. `inputs`, if given, records every file that is read.
/// `wavelengths_nm` [nm], unless empty, replace the lens's own, with the element number size/2 as the
/// primary. Stop and image are still set at the lens's own primary wavelength. Throws Error{input} if the
/// folder of the shipped tables does not exist, and Error{resource} if the memory limit of `inputs` is
/// exceeded.
[[nodiscard]] std::optional<lens::System> load_lens(const std::string& name, Diagnostics& diagnostics,
                                                    Inputs* inputs = nullptr,
                                                    const SourcePosition& where = {},
                                                    const std::vector<double>& wavelengths_nm = {});

/// The names of the lenses of `data/lens`, without extension and sorted; empty if there is no such folder.
/// Throws Error{input} if the folder of the shipped tables does not exist.
[[nodiscard]] std::vector<std::string> lens_names();

}  // namespace abbe
