#pragma once

#include <filesystem>
#include <optional>

#include "description/lens.h"

namespace abbe::description {

/// Reads a lens as pbrt does: a row per surface of radius, thickness, index behind it and diameter [mm], from
/// the object to the film; radius 0 is the stop, index 0 or 1 air, "#" opens a remark, the first of which is
/// the title. The film is at the paraxial focus. Reports rows of other lengths and what is no number.
[[nodiscard]] std::optional<spec::Lens> read_pbrt_table(const std::filesystem::path& file,
                                                        Diagnostics& diagnostics);

}  // namespace abbe::description
