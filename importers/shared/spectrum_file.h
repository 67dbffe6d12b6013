#pragma once

#include <filesystem>
#include <optional>

#include "importers/shared/spectra.h"

namespace abbe::importers {

/// Reads a text file with a wavelength [nm] and a value per line, separated by blanks, tabs or a comma; `#`
/// begins a comment. The samples clamp at their ends. Reports to `importer.diagnostics`:
/// - a missing or unreadable file, at `where`;
/// - malformed lines, fewer than two samples and wavelengths that do not ascend, at their positions in the
/// file. Returns nothing after an error. Throws Error{resource} if the memory limit of `importer.inputs` is
/// exceeded.
[[nodiscard]] std::optional<Samples> read_spectrum_file(const std::filesystem::path& file,
                                                        const SourcePosition& where, SceneImporter& importer);

}  // namespace abbe::importers
