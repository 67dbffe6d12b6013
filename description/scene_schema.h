#pragma once

#include <string>

namespace abbe {

/// The text of `docs/scene.schema.json`: the JSON Schema of scene files, from the tables of their fields.
[[nodiscard]] std::string scene_schema();

}  // namespace abbe
