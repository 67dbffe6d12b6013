#include "description/convert.h"

#include "description/scene.h"
#include "description/scene_schema.h"
#include "io/schema/write.h"

namespace abbe {

std::optional<std::string> canonical_scene(const std::filesystem::path& path,
                                           std::span<const Override> overrides, Diagnostics& diagnostics,
                                           Inputs* inputs) {
  spec::Scene said;
  if (!load_scene(path, overrides, diagnostics, inputs, &said)) return std::nullopt;
  std::string text = to_lines(schema::write(said), kJsonWidth);
  // Overrides may nest what they put together deeper than a file may be.
  const auto source = std::make_shared<const SourceText>(SourceText{path.string(), text});
  HeldMemory tree(inputs, 0);
  if (!parse_json(source, diagnostics, &tree)) return std::nullopt;
  return text;
}

}  // namespace abbe
