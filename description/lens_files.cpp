#include "description/lens_files.h"

#include <algorithm>

#include <fmt/format.h>

#include "io/data_directory.h"
#include "io/schema/read.h"
#include "io/text.h"

namespace abbe::description::lenses {
namespace {

constexpr std::string_view kBlanks = " \t\r";
constexpr double kMaxPositive = 1e9;

}  // namespace

SourcePosition Line::where(std::size_t word) const {
  return {source, words[std::min(word, words.size() - 1)].offset, ""};
}

std::optional<std::string> Line::text(std::size_t word) const {
  return word < words.size() ? std::optional(words[word].text) : std::nullopt;
}

std::optional<double> Line::number(std::size_t word, Diagnostics& diagnostics) const {
  const auto word_text = text(word);
  const auto value = word_text ? parse_number(*word_text) : std::nullopt;
  if (!value)
    diagnostics.error(where(word),
                      fmt::format("{} needs a number here (got {})", keyword(),
                                  word_text ? fmt::format("\"{}\"", *word_text) : "the end of the line"),
                      ErrorCode::input);
  return value;
}

std::optional<double> Line::positive(std::size_t word, Diagnostics& diagnostics) const {
  const auto value = number(word, diagnostics);
  if (!value || (*value > 0 && *value <= kMaxPositive)) return value;
  diagnostics.error(where(word),
                    fmt::format("{} needs a number above 0 here (got {:g}, allowed (0, {:g}])", keyword(),
                                *value, kMaxPositive),
                    ErrorCode::input);
  return std::nullopt;
}

std::vector<double> Line::numbers(std::size_t first) const {
  std::vector<double> values;
  for (std::size_t i = first; i < words.size(); ++i) {
    const auto value = parse_number(words[i].text);
    if (!value) break;
    values.push_back(*value);
  }
  return values;
}

std::vector<Line> lines_of(const std::shared_ptr<const SourceText>& source) {
  const std::string& text = source->text;
  std::vector<Line> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    Line line{source, {}, kBlanks.find(text[begin]) != std::string_view::npos};
    for (std::size_t at = begin;;) {
      at = std::min(text.find_first_not_of(kBlanks, at), end);
      if (at >= end) break;
      const std::size_t stop = std::min(text.find_first_of(kBlanks, at), end);
      line.words.push_back({text.substr(at, stop - at), at});
      at = stop;
    }
    if (!line.words.empty()) lines.push_back(std::move(line));
    begin = end + 1;
  }
  return lines;
}

}  // namespace abbe::description::lenses

namespace abbe {
namespace {

namespace fs = std::filesystem;

std::optional<spec::Lens> read_json(const fs::path& file, Diagnostics& diagnostics) {
  const auto source = read_text(file, diagnostics);
  auto root = source ? parse_json(source, diagnostics) : std::nullopt;
  if (!root) return std::nullopt;
  return schema::read<spec::Lens>(*root, diagnostics);
}

using description::lenses::Line;

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

// Reads a lens in pbrt's format: one row per surface with radius, thickness, index behind it and diameter
// [mm], from the object to the film. A radius of 0 marks the stop, an index of 0 or 1 is air. "#" starts a
// comment; the first comment is the title. The film is at the paraxial focus. Returns nothing if the
// diagnostics then have an error.
std::optional<spec::Lens> read_pbrt_table(const fs::path& file, Diagnostics& diagnostics) {
  const auto source = read_text(file, diagnostics);
  if (!source) return std::nullopt;
  spec::Lens lens;
  lens.where = {source, SourcePosition::kWholeFile, ""};
  lens.focus = spec::LensFocus::paraxial;
  for (const Line& line : description::lenses::lines_of(source)) {
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

using Reader = std::optional<spec::Lens> (*)(const fs::path&, Diagnostics&);

// The reader for the extension of a file; nullptr for an unknown extension.
Reader reader_of(const fs::path& file) {
  const std::string extension = extension_of(file);
  if (extension == ".json") return read_json;
  if (extension == ".zmx") return description::read_zemax;
  if (extension == ".dat") return read_pbrt_table;
  return nullptr;
}

}  // namespace

std::optional<lens::System> load_lens(const std::string& name, Diagnostics& diagnostics, Inputs* inputs,
                                      const SourcePosition& where,
                                      const std::vector<double>& wavelengths_nm) {
  fs::path file = name;
  if (reader_of(file) == nullptr) {
    const std::vector<std::string> names = description::shipped_names("lens");
    if (std::ranges::find(names, name) == names.end()) {
      diagnostics.error(where, unknown_name("lens", name, names) + "; files end in .json, .zmx or .dat",
                        ErrorCode::input);
      return std::nullopt;
    }
    file = data_directory() / "lens" / (name + ".json");
  }
  const auto spec = reader_of(file)(file, diagnostics);
  if (inputs != nullptr) inputs->add_file(file);
  description::LoadContext context{diagnostics, file.parent_path(), inputs};
  auto system = spec ? description::build(*spec, context, wavelengths_nm) : std::nullopt;
  if (system && system->title.empty()) system->title = file.stem().string();
  return system;
}

}  // namespace abbe
