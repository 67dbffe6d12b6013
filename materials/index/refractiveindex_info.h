#pragma once

#include <filesystem>
#include <optional>

#include "io/diagnostics.h"
#include "materials/index/named_index.h"

namespace abbe {

/// Reads a file of the refractiveindex.info database (`.yml`): of its DATA, one block that gives n ("formula
/// 1" to "formula 9", "tabulated n", "tabulated nk") and perhaps another that gives k ("tabulated nk",
/// "tabulated k"); REFERENCES and COMMENTS become the source; `n_is_absolute` and `wavelength_is_vacuum` of
/// SPECS, CONDITIONS or PROPERTIES, or `n_absolute` and `wavelength_vacuum`, as earlier editions spell them,
/// say what index and wavelengths refer to, air unless they do. Beyond its table k is held from the nearer
/// end. Reports, as input errors at their place in the file, whatever is missing, no number, out of order,
/// out of place or contradictory: nothing is guessed. [Polyanskiy2024]
[[nodiscard]] std::optional<NamedIndex> read_refractiveindex_info(const std::filesystem::path& path,
                                                                  Diagnostics& diagnostics);

}  // namespace abbe
