#pragma once

#include <cstddef>
#include <string>

namespace abbe {

/// Line width of the JSON that Abbe writes for readers [characters].
inline constexpr std::size_t kJsonWidth = 140;

/// The text of `docs/scene.schema.json`: the JSON Schema of scene files, generated from the key tables.
[[nodiscard]] std::string scene_schema();

/// The text of `docs/scene.md` with its key tables regenerated from those of the program. `guide` is its
/// current text, from which everything else is taken. Throws Error{internal} if it names an unknown table or
/// a table has no end.
[[nodiscard]] std::string scene_guide(const std::string& guide);

}  // namespace abbe
