#pragma once

#include <filesystem>
#include <optional>

#include "description/lens.h"

namespace abbe::description {

/// Reads a lens in pbrt's format: one row per surface with radius, thickness, index behind it and diameter
/// [mm], from the object to the film.
/// - A radius of 0 marks the stop.
/// - An index of 0 or 1 is air.
/// - "#" starts a comment; the first comment is the title.
/// The film is at the paraxial focus. Reports to `diagnostics`, and returns nothing if they then have an
/// error:
/// - a file that cannot be read, and one without rows;
/// - rows of another length and words that are not numbers;
/// - a negative index, and a diameter of 0 or less.
[[nodiscard]] std::optional<spec::Lens> read_pbrt_table(const std::filesystem::path& file,
                                                        Diagnostics& diagnostics);

}  // namespace abbe::description
