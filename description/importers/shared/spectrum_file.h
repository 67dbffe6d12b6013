#pragma once

#include <filesystem>
#include <optional>

#include "description/importers/shared/spectra.h"

namespace abbe::importers {

/// Reads a text file with a wavelength [nm] and a value per line; `#` begins a comment. Reports a missing
/// file at `where`, and malformed lines and wavelengths that do not ascend in the file. Nothing after an
/// error.
[[nodiscard]] std::optional<Samples> read_spectrum_file(const std::filesystem::path& file,
                                                        const SourcePosition& where, SceneImporter& importer);

}  // namespace abbe::importers
