#include "description/convert.h"

#include "description/scene.h"
#include "description/scene_schema.h"
#include "io/schema/write.h"

namespace abbe {

std::optional<std::string> canonical_scene(const std::filesystem::path& path,
                                           std::span<const Override> overrides, Diagnostics& diagnostics,
                                           Inputs* inputs) {
  spec::Scene spec;
  if (!load_scene(path, overrides, diagnostics, inputs, &spec)) return std::nullopt;
  std::string text = to_lines(schema::write(spec), kJsonWidth);
  // Overrides may nest JSON deeper than a file may be.
  const auto source = std::make_shared<const SourceText>(SourceText{path.string(), text});
  MemoryReservation tree_memory(inputs, 0);
  if (!parse_json(source, diagnostics, &tree_memory)) return std::nullopt;
  return text;
}

}  // namespace abbe
