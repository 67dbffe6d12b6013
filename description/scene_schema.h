#pragma once

#include <cstddef>
#include <string>

namespace abbe {

/// Line width of the JSON that Abbe writes for readers.
inline constexpr std::size_t kJsonWidth = 140;

/// The text of `docs/scene.schema.json`: the JSON Schema of scene files, generated from the key tables.
[[nodiscard]] std::string scene_schema();

/// The text of `docs/scene.md` with its key tables regenerated. `guide` is its current text.
[[nodiscard]] std::string scene_guide(const std::string& guide);

}  // namespace abbe
