#pragma once

#include <cstddef>
#include <string>

namespace abbe {

/// Columns of the JSON that Abbe writes for people.
inline constexpr std::size_t kJsonWidth = 140;

/// The text of `docs/scene.schema.json`: the JSON Schema of scene files, from the tables of their fields.
[[nodiscard]] std::string scene_schema();

/// The text of `docs/scene.md`, given as it is now, with its tables of keys from those of the scene's fields.
[[nodiscard]] std::string scene_guide(const std::string& guide);

}  // namespace abbe
