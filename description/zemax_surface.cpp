#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "description/zemax_reader.h"
#include "materials/index/library.h"

// Reads the surfaces of a `.zmx` file.
namespace abbe::description::zemax {
namespace {

constexpr double kInfinity =
    1e10;  // Older files have this number in place of INFINITY; larger ones count as infinite too.

}  // namespace

const std::map<std::string, Reader::Handler>& Reader::surface_handlers() {
  static const std::map<std::string, Handler> kWords{
      {"TYPE", &Reader::type},           {"CURV", &Reader::curvature},
      {"DISZ", &Reader::thickness},      {"GLAS", &Reader::glass},
      {"CONI", &Reader::conic},          {"PARM", &Reader::parameter},
      {"STOP", &Reader::stop},           {"DIAM", &Reader::diameter},
      {"CLAP", &Reader::clear_aperture}, {"FLAP", &Reader::floating_aperture},
      {"COAT", &Reader::coating}};
  return kWords;
}

void Reader::surface(const Line& line) {
  const auto number = line.number(1, diagnostics_);
  if (number && *number != static_cast<double>(surfaces_.size()))
    error(
        line, 1,
        fmt::format("surfaces must be numbered in order (got {:g}, expected {})", *number, surfaces_.size()));
  surfaces_.emplace_back().surface.where = line.where();
}

void Reader::type(const Line& line) {
  current().has_type = true;
  const std::string given = line.text(1).value_or("");
  if (given != "STANDARD" && given != "EVENASPH")
    error(line, 1,
          fmt::format("this type of surface is not supported (got {}, allowed STANDARD, EVENASPH)", given));
  current().standard = given == "STANDARD";
}

void Reader::curvature(const Line& line) {
  current().has_curvature = true;
  current().curvature = line.number(1, diagnostics_).value_or(0);
  if (is_object() && current().curvature != 0)
    error(line, 1,
          fmt::format("a curved object is not supported (got {:g}, allowed 0)", current().curvature));
}

void Reader::thickness(const Line& line) {
  current().has_thickness = true;
  const auto given = line.text(1) == "INFINITY" ? kInfinity : line.number(1, diagnostics_);
  if (!given) return;
  current().at_infinity = *given >= kInfinity;
  if (current().at_infinity) {
    if (!is_object()) error(line, 1, "only the object can be at infinity");
    return;
  }
  current().surface.thickness = *given;
  if (is_object() && !spec::kPositiveMm.contains(*given * unit_mm_))
    error(line, 1,
          fmt::format("distance of the object out of range (got {:g} mm, allowed {} mm)", *given * unit_mm_,
                      spec::kPositiveMm.text()));
}

// Looks up the glass in the catalogues that the file names, in their order; else in all catalogues, with a
// warning. Another maker's glass of the same name may differ, and a catalogue of the file may be unknown to
// Abbe.
spec::LensGlass Reader::named_glass(const Line& line) const {
  std::string name = line.words[1].text;
  const std::vector<std::string> sold = glass_names();
  const auto has_it = [&](const std::string& maker) {
    return std::binary_search(sold.begin(), sold.end(), maker + "/" + name);
  };
  const auto maker = std::find_if(catalogues_.begin(), catalogues_.end(), has_it);
  if (maker != catalogues_.end())
    name = *maker + "/" + name;
  else if (!catalogues_.empty())
    diagnostics_.warning(
        line.where(1),
        fmt::format(
            "{} is in none of the file's catalogues known to Abbe (got GCAT {}): all catalogues are searched",
            name, fmt::join(catalogues_, " ")));
  spec::LensGlass glass;
  spec::Ior ior;
  ior.value = name;
  ior.where = glass.where = line.where(1);
  glass.value = ior;
  return glass;
}

// A glass of three numbers: an index, an Abbe number (0 without dispersion), and the deviation of the partial
// dispersion from the normal line.
std::optional<spec::LensGlass> Reader::model_glass(const Line& line) {
  constexpr Range kIndex{1, spec::kModelIndex.high};
  const auto nd = line.number(4, diagnostics_);
  const auto vd = line.number(5, diagnostics_);
  const auto partial = line.text(6) ? line.number(6, diagnostics_) : 0;
  if (!nd || !vd || !partial) return std::nullopt;
  if (!kIndex.contains(*nd))
    error(line, 4, fmt::format("index out of range (got {:g}, allowed {})", *nd, kIndex.text()));
  if (*vd != 0 && !spec::kAbbeNumber.contains(*vd))
    error(line, 5,
          fmt::format("Abbe number out of range (got {:g}, allowed {} or 0)", *vd, spec::kAbbeNumber.text()));
  if (*partial != 0)
    error(line, 6,
          fmt::format("a deviating partial dispersion is not supported (got {:g}, allowed 0)", *partial));
  spec::LensGlass glass;
  glass.where = line.where(1);
  if (*vd != 0)
    glass.value = spec::ModelGlass{*nd, *vd};
  else
    glass.value = spec::Ior{{{*nd}, line.where(4)}};
  return glass;
}

void Reader::glass(const Line& line) {
  const std::string given = line.text(1).value_or("");
  if (given == "MIRROR") return error(line, 1, "mirrors are not supported, only refracting lenses");
  if (given.empty()) return error(line, 0, "GLAS needs the name of a glass");
  if (is_object())
    return error(line, 1, fmt::format("an object in glass is not supported (got {}, allowed air)", given));
  if (given == "___BLANK")
    current().surface.glass = model_glass(line);
  else
    current().surface.glass = named_glass(line);
}

void Reader::conic(const Line& line) {
  current().surface.conic = line.number(1, diagnostics_).value_or(0);
}

void Reader::parameter(const Line& line) {
  const auto number = line.number(1, diagnostics_);
  const auto value = line.number(2, diagnostics_);
  if (!number || !value || *value == 0) return;
  if (!current().parameter) current().parameter = line;
  if (*number >= 1 && *number <= static_cast<double>(kEvenCoefficients))
    current().even[static_cast<std::size_t>(*number) - 1] = *value;
  else
    error(line, 1, fmt::format("unknown parameter (got {:g}, allowed 1 to {})", *number, kEvenCoefficients));
}

void Reader::stop(const Line& line) {
  if (is_object()) error(line, 0, "the object cannot be the stop");
  current().surface.stop = true;
}

// The second number distinguishes a diameter that the user has set from one that Zemax has calculated.
void Reader::diameter(const Line& line) {
  current().semi_diameter = line.number(1, diagnostics_).value_or(0);
  if (line.text(2) == "1") current().fixed = true;
}

void Reader::clear_aperture(const Line& line) {
  const auto inner = line.number(1, diagnostics_);
  const auto outer = line.positive(2, diagnostics_);
  if (inner && *inner != 0) error(line, 1, "apertures with a hole are not supported");
  if (outer) current().surface.aperture = *outer;
}

void Reader::coating(const Line& line) {
  diagnostics_.warning(line.where(1),
                       fmt::format("the coating {} is ignored, because its layers are in another file",
                                   line.text(1).value_or("")));
}

spec::LensSurface Reader::finished(const ReadSurface& read) const {
  spec::LensSurface surface = read.surface;
  surface.radius = read.curvature == 0 ? 0 : unit_mm_ / read.curvature;
  surface.thickness *= unit_mm_;
  surface.r2 = read.even[0] / unit_mm_;
  for (std::size_t i = 1; i < read.even.size(); ++i)
    surface.asphere.push_back(read.even[i] / std::pow(unit_mm_, 2.0 * static_cast<double>(i) + 1));
  if (!surface.aperture && (read.fixed || (open_by_stop_ && surface.stop)) && read.semi_diameter > 0)
    surface.aperture = read.semi_diameter;
  if (surface.aperture) *surface.aperture *= unit_mm_;
  return surface;
}

}  // namespace abbe::description::zemax
