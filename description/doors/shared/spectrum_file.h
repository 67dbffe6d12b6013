#pragma once

#include <filesystem>
#include <optional>

#include "description/doors/shared/spectra.h"

namespace abbe::doors {

/// Reads a file of lines with a wavelength [nm] and a value each, where `#` begins a comment. Reports, at
/// `where` a file that is not there, and in the file a line that is no such pair, and wavelengths that do not
/// ascend.
[[nodiscard]] std::optional<Samples> read_spectrum_file(const std::filesystem::path& file,
                                                        const SourcePosition& where, Door& door);

}  // namespace abbe::doors
