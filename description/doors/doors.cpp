#include "description/doors/doors.h"

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>

#include <fmt/format.h>

#include "description/doors/gltf/reader.h"
#include "description/doors/mitsuba/reader.h"
#include "description/doors/pbrt/reader.h"
#include "description/doors/shared/door.h"
#include "description/doors/shared/materials.h"
#include "description/load.h"
#include "description/scene_schema.h"
#include "io/extension.h"
#include "io/schema/write.h"

namespace abbe {
namespace {

using Read = bool (*)(const std::filesystem::path& file, doors::Door& door);

struct Format {
  std::string_view extension;
  Read read;
};
constexpr std::array<Format, 4> kFormats{{{".glb", doors::read_gltf_scene},
                                          {".gltf", doors::read_gltf_scene},
                                          {".pbrt", doors::read_pbrt},
                                          {".xml", doors::read_mitsuba}}};

const Format* format_of(const std::filesystem::path& path) {
  const auto* found = std::ranges::find(kFormats, extension_of(path), &Format::extension);
  return found == kFormats.end() ? nullptr : found;
}

std::string told(const doors::Note& note) {
  return note.count == 1 ? note.text : fmt::format("{} ({} times)", note.text, note.count);
}

// The text in one line, as a comment holds it.
std::string in_one_line(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
}

// What was approximated or dropped, as warnings and as comments.
std::string tell_notes(const std::filesystem::path& path, doors::Door& door) {
  std::string comments = fmt::format("// Converted from {}.", in_one_line(path.filename().string()));
  if (!door.notes.empty()) comments += " Approximated or dropped:";
  comments += '\n';
  for (const doors::Note& note : door.notes) {
    door.diagnostics.warning(note.where, told(note));
    Diagnostics alone;
    alone.warning(note.where, told(note));
    const std::string line = format(alone.all()[0]);
    comments += "//   " + line.substr(0, line.find('\n')) + '\n';
  }
  return comments;
}

}  // namespace

bool is_other_scene(const std::filesystem::path& path) {
  return format_of(path) != nullptr;
}

std::optional<std::string> convert_scene(const std::filesystem::path& path, const Conversion& conversion,
                                         Diagnostics& diagnostics, Inputs* inputs) {
  doors::Door door{diagnostics, inputs, conversion.folder, path.string()};
  if (!format_of(path)->read(path, door)) return std::nullopt;
  if (conversion.materials) doors::replace_materials(*conversion.materials, door);
  if (diagnostics.has_errors()) return std::nullopt;
  HeldMemory written(inputs, 0);
  written.take_more(door.file, door.bytes_to_write());
  const std::string text = tell_notes(path, door) + to_lines(schema::write(door.scene), kJsonWidth);
  // What is written must be a scene: what is wrong with it is told as of it.
  const auto source = std::make_shared<const SourceText>(
      SourceText{fmt::format("what {} became", path.filename().string()), text});
  if (!load_scene(source, conversion.folder, {}, diagnostics, inputs)) return std::nullopt;
  return text;
}

}  // namespace abbe
