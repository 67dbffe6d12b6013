#pragma once

#include <optional>
#include <string>

#include "io/diagnostics.h"
#include "io/inputs.h"
#include "materials/material.h"

namespace abbe {

/// Reads and builds one material, which `words` gives as one of:
/// - JSON text that begins with "{";
/// - the name of a file with such text;
/// - "FILE.json:NAME", one of the `materials` of a scene; ":NAME" may be omitted if there is only one.
/// Lengths are in the `units` of the text, or metres without that key. All materials of a scene are built.
/// Reports every error to `diagnostics`; returns nothing if they then have one. `inputs`, if given, records
/// the files that are read. Throws Error{resource} if its memory limit is exceeded.
[[nodiscard]] std::optional<Material> load_material(const std::string& words, Diagnostics& diagnostics,
                                                    Inputs* inputs = nullptr);

}  // namespace abbe
