#pragma once

#include <filesystem>
#include <optional>

#include "io/diagnostics.h"
#include "materials/index/named_index.h"

namespace abbe {

/// Reads a file of the refractiveindex.info database (`.yml`). [Polyanskiy2024]
/// - DATA has one block that gives n ("formula 1" to "formula 9", "tabulated n", "tabulated nk") and
///   optionally one that gives k ("tabulated nk", "tabulated k"). Outside its table k has the value at the
///   nearer end.
/// - REFERENCES and COMMENTS become the source.
/// - `n_is_absolute` and `wavelength_is_vacuum` in SPECS, CONDITIONS or PROPERTIES are true for an index
///   relative to vacuum and for wavelengths in vacuum; air is the default. Earlier editions spell them
///   `n_absolute` and `wavelength_vacuum`.
/// Anything missing, malformed, out of order, misplaced or contradictory is reported as an input error with
/// its position; the result is then empty.
[[nodiscard]] std::optional<NamedIndex> read_refractiveindex_info(const std::filesystem::path& path,
                                                                  Diagnostics& diagnostics);

}  // namespace abbe
