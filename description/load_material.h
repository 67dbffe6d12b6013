#pragma once

#include <optional>
#include <string>

#include "io/diagnostics.h"
#include "io/inputs.h"
#include "materials/material.h"

namespace abbe {

/// One material as scenes describe it: JSON text that opens with "{", a file of such text, or
/// "FILE.json:NAME" out of the `materials` of a scene (the name may be left out where there is one only).
/// Everything wrong is reported; nothing is returned if there is an error. `inputs` as for `load_scene`.
[[nodiscard]] std::optional<Material> load_material(const std::string& words, Diagnostics& diagnostics,
                                                    Inputs* inputs = nullptr);

}  // namespace abbe
