#include "description/zemax.h"

#include <fmt/format.h>

#include "description/zemax_keywords.h"
#include "description/zemax_reader.h"
#include "io/text.h"

namespace abbe::description {
namespace zemax {

void Reader::read_line(const Line& line) {
  const auto& words = surfaces_.empty() ? system_handlers() : surface_handlers();
  const auto found = words.find(line.keyword());
  ended_ =
      ended_ || (!surfaces_.empty() && !line.indented && found == words.end() && line.keyword() != "SURF");
  if (ended_) {
    if (line.keyword() == "MNUM") configurations(line);
  } else if (line.keyword() == "SURF") {
    surface(line);
  } else if (found != words.end()) {
    (this->*found->second)(line);
  } else if (!is_ignored(line.keyword())) {
    report_unknown(line);
  }
}

void Reader::report_unknown(const Line& line) {
  std::vector<std::string> known = ignored_words();
  for (const auto& [word, handler] : surfaces_.empty() ? system_handlers() : surface_handlers())
    known.push_back(word);
  error(line, 0, unknown_name("keyword of Zemax", line.keyword(), known));
}

// Reports parameters that the surface type does not have. Checked at the end, because the type may follow its
// parameters.
void Reader::check_parameters(const ReadSurface& read, bool object) {
  if (!read.parameter) return;
  const std::string given = read.parameter->text(2).value_or("");
  if (read.standard)
    error(*read.parameter, 2,
          fmt::format("a STANDARD surface has no parameters: is it an EVENASPH? (got {}, allowed 0)", given));
  else if (object)
    error(*read.parameter, 2, fmt::format("a curved object is not supported (got {}, allowed 0)", given));
}

// Reports an incomplete file: each surface needs all of its data, and the image must be plane and in air.
void Reader::require_complete() {
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    const ReadSurface& read = surfaces_[i];
    check_parameters(read, i == 0);
    for (const auto& [present, word] :
         {std::pair(read.has_type, "TYPE"), std::pair(read.has_curvature, "CURV"),
          std::pair(read.has_thickness, "DISZ")})
      if (!present)
        diagnostics_.error(read.surface.where,
                           fmt::format("surface {} has no {}: is the file cut short?", i, word),
                           ErrorCode::input);
  }
  const ReadSurface& image = surfaces_.back();
  if (image.surface.glass || image.curvature != 0 || image.parameter || image.surface.stop)
    diagnostics_.error(
        image.surface.where,
        "the last surface, which is the image, must be plane, in air and not the stop: is the file cut "
        "short?",
        ErrorCode::input);
}

std::optional<spec::Lens> Reader::read(const std::shared_ptr<const SourceText>& source) {
  lens_.where = {source, SourcePosition::kWholeFile, ""};
  for (const Line& line : lenses::lines_of(source)) read_line(line);
  if (surfaces_.size() < 3) {
    diagnostics_.error(
        lens_.where,
        fmt::format("a lens of Zemax has an object, surfaces and an image (got {} SURF, expected 3 or "
                    "more): is the file cut short?",
                    surfaces_.size()),
        ErrorCode::input);
    return std::nullopt;
  }
  require_complete();
  if (!surfaces_.front().at_infinity) lens_.object_distance = surfaces_.front().surface.thickness * unit_mm_;
  for (std::size_t i = 1; i + 1 < surfaces_.size(); ++i) lens_.surfaces.push_back(finished(surfaces_[i]));
  if (auto* pupil = std::get_if<spec::PupilDiameter>(&lens_.aperture)) pupil->value *= unit_mm_;
  finish_fields();
  finish_wavelengths();
  return diagnostics_.has_errors() ? std::nullopt : std::optional(std::move(lens_));
}

}  // namespace zemax

std::optional<spec::Lens> read_zemax(const std::filesystem::path& file, Diagnostics& diagnostics) {
  const auto source = read_unicode_text(file, diagnostics);
  return source ? zemax::Reader(diagnostics).read(source) : std::nullopt;
}

}  // namespace abbe::description
