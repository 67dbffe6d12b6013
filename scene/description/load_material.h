#pragma once

#include <optional>
#include <string>

#include "io/diagnostics.h"
#include "materials/material.h"

namespace abbe {

/// One material as scenes describe it: JSON text that opens with "{", a file of such text, or
/// "FILE.json:NAME" out of the `materials` of a scene (the name may be left out where there is one only).
/// Everything wrong is reported; nothing is returned if there is an error.
[[nodiscard]] std::optional<Material> load_material(const std::string& words, Diagnostics& diagnostics);

}  // namespace abbe
