#include "importers/importers.h"

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>

#include <fmt/format.h>

#include "description/load.h"
#include "importers/shared/materials.h"
#include "importers/shared/scene_importer.h"
#include "io/schema/write.h"
#include "io/text.h"

namespace abbe {
namespace {

using ReadFunction = bool (*)(const std::filesystem::path& file, importers::SceneImporter& importer);

struct SceneFormat {
  std::string_view extension;
  ReadFunction read;
};
constexpr std::array<SceneFormat, 4> kFormats{{{".glb", importers::read_gltf_scene},
                                               {".gltf", importers::read_gltf_scene},
                                               {".pbrt", importers::read_pbrt},
                                               {".xml", importers::read_mitsuba}}};

const SceneFormat* format_of(const std::filesystem::path& path) {
  const auto* found = std::ranges::find(kFormats, extension_of(path), &SceneFormat::extension);
  return found == kFormats.end() ? nullptr : found;
}

std::string note_text(const importers::Note& note) {
  return note.count == 1 ? note.text : fmt::format("{} ({} times)", note.text, note.count);
}

// Replaces line breaks by blanks, since the text is part of a comment.
std::string in_one_line(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
}

// Reports what was approximated or dropped as warnings and returns it as comments.
std::string report_notes(const std::filesystem::path& path, importers::SceneImporter& importer) {
  std::string comments = fmt::format("// Converted from {}.", in_one_line(path.filename().string()));
  if (!importer.notes.empty()) comments += " Approximated or dropped:";
  comments += '\n';
  for (const importers::Note& note : importer.notes) {
    importer.diagnostics.warning(note.where, note_text(note));
    Diagnostics alone;
    alone.warning(note.where, note_text(note));
    const std::string line = format(alone.all()[0]);
    comments += "//   " + line.substr(0, line.find('\n')) + '\n';
  }
  return comments;
}

}  // namespace

bool is_importable_scene(const std::filesystem::path& path) {
  return format_of(path) != nullptr;
}

std::optional<std::string> convert_scene(const std::filesystem::path& path,
                                         const ConversionOptions& conversion, Diagnostics& diagnostics,
                                         Inputs* inputs) {
  importers::SceneImporter importer{diagnostics, inputs, conversion.folder, path.string()};
  if (!format_of(path)->read(path, importer)) return std::nullopt;
  if (conversion.materials) importers::replace_materials(*conversion.materials, importer);
  if (diagnostics.has_errors()) return std::nullopt;
  MemoryReservation written(inputs, 0);
  written.reserve(importer.file, importer.bytes_to_write());
  const std::string text = report_notes(path, importer) + to_lines(schema::write(importer.scene), kJsonWidth);
  // Checks that the result is a valid scene; errors refer to its text.
  const auto source = std::make_shared<const SourceText>(
      SourceText{fmt::format("{} (converted)", path.filename().string()), text});
  if (!load_scene(source, conversion.folder, {}, diagnostics, inputs)) return std::nullopt;
  return text;
}

}  // namespace abbe
