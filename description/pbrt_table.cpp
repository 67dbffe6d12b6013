#include "description/pbrt_table.h"

#include <fmt/format.h>

#include "description/lens_file_lines.h"
#include "io/text.h"

namespace abbe::description {
namespace {

using lenses::Line;

constexpr std::size_t kRowNumbers = 4;

void read_row(const Line& line, spec::Lens& lens, Diagnostics& diagnostics) {
  const std::vector<double> row = line.numbers(0);
  const bool ends = row.size() == line.words.size() || line.words[row.size()].text.starts_with('#');
  if (!ends || row.size() != kRowNumbers)
    return diagnostics.error(
        line.where(row.size()),
        fmt::format("a row is radius, thickness, index and diameter (got {} numbers, expected {})",
                    row.size(), kRowNumbers),
        ErrorCode::input);
  const auto [radius, thickness, index, diameter] = std::tuple(row[0], row[1], row[2], row[3]);
  if (!(diameter > 0) || index < 0)
    return diagnostics.error(
        line.where(diameter > 0 ? 2 : 3),
        fmt::format("index and diameter must not be negative (got {:g} and {:g})", index, diameter),
        ErrorCode::input);
  spec::LensSurface surface;
  surface.where = line.where();
  surface.radius = radius;
  surface.thickness = thickness;
  surface.stop = radius == 0;
  surface.aperture = diameter / 2;
  if (index != 0 && index != 1) {
    surface.glass.emplace();
    surface.glass->where = line.where(2);
    surface.glass->value = spec::Ior{{{index}, line.where(2)}};
  }
  lens.surfaces.push_back(std::move(surface));
}

}  // namespace

std::optional<spec::Lens> read_pbrt_table(const std::filesystem::path& file, Diagnostics& diagnostics) {
  const auto source = read_text(file, diagnostics);
  if (!source) return std::nullopt;
  spec::Lens lens;
  lens.where = {source, SourcePosition::kWholeFile, ""};
  lens.focus = spec::LensFocus::paraxial;
  for (const Line& line : lenses::lines_of(source)) {
    if (!line.keyword().starts_with('#')) {
      read_row(line, lens, diagnostics);
    } else if (lens.title.empty()) {
      const std::size_t begin = source->text.find_first_not_of("# \t", line.words[0].offset);
      lens.title = source->text.substr(begin, source->text.find_first_of("\r\n", begin) - begin);
    }
  }
  if (lens.surfaces.empty())
    diagnostics.error(lens.where, "a lens needs surfaces: the table has no row", ErrorCode::input);
  return diagnostics.has_errors() ? std::nullopt : std::optional(std::move(lens));
}

}  // namespace abbe::description
