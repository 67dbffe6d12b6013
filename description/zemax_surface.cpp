#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "description/zemax_reader.h"
#include "materials/index/library.h"

// The surfaces of a `.zmx` file.
namespace abbe::description::zemax {
namespace {

constexpr double kInfinity = 1e10;  // what older files have in place of the word, and whatever is beyond

}  // namespace

const std::map<std::string, Reader::Handler>& Reader::surface_words() {
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
    error(line, 1,
          fmt::format("surfaces are numbered in their order (got {:g}, expected {})", *number,
                      surfaces_.size()));
  surfaces_.emplace_back().surface.where = line.where();
}

void Reader::type(const Line& line) {
  now().has_type = true;
  const std::string said = line.text(1).value_or("");
  if (said != "STANDARD" && said != "EVENASPH")
    error(line, 1,
          fmt::format("this type of surface is not understood (got {}, allowed STANDARD, EVENASPH)", said));
  now().standard = said == "STANDARD";
}

void Reader::curvature(const Line& line) {
  now().has_curvature = true;
  now().curvature = line.number(1, diagnostics_).value_or(0);
  if (is_object() && now().curvature != 0)
    error(line, 1, fmt::format("a curved object is not understood (got {:g}, allowed 0)", now().curvature));
}

void Reader::thickness(const Line& line) {
  now().has_thickness = true;
  const auto said = line.text(1) == "INFINITY" ? kInfinity : line.number(1, diagnostics_);
  if (!said) return;
  now().at_infinity = *said >= kInfinity;
  if (now().at_infinity) {
    if (!is_object()) error(line, 1, "only the object can be at infinity");
    return;
  }
  now().surface.thickness = *said;
  if (is_object() && !spec::kPositiveMm.contains(*said * unit_mm_))
    error(line, 1,
          fmt::format("distance of the object out of range (got {:g} mm, allowed {} mm)", *said * unit_mm_,
                      spec::kPositiveMm.text()));
}

// As the first of the file's catalogues sells it, else as scenes find it, which is told: another maker's
// glass of the name may differ, and a catalogue may be one that is not known here.
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
    diagnostics_.warning(line.where(1),
                         fmt::format("{} is in none of the file's catalogues that are known here (got GCAT "
                                     "{}): it is looked for in all",
                                     name, fmt::join(catalogues_, " ")));
  spec::LensGlass glass;
  spec::Ior ior;
  ior.value = name;
  ior.where = glass.where = line.where(1);
  glass.value = ior;
  return glass;
}

// An index, an Abbe number that is 0 without dispersion, and how far the partial dispersion is off the line
// of normal glasses.
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
          fmt::format("a partial dispersion of its own is not understood (got {:g}, allowed 0)", *partial));
  spec::LensGlass glass;
  glass.where = line.where(1);
  if (*vd != 0)
    glass.value = spec::ModelGlass{*nd, *vd};
  else
    glass.value = spec::Ior{{{*nd}, line.where(4)}};
  return glass;
}

void Reader::glass(const Line& line) {
  const std::string said = line.text(1).value_or("");
  if (said == "MIRROR") return error(line, 1, "mirrors are not understood: lenses refract alone");
  if (said.empty()) return error(line, 0, "GLAS names a glass");
  if (is_object())
    return error(line, 1, fmt::format("an object in glass is not understood (got {}, allowed air)", said));
  if (said == "___BLANK")
    now().surface.glass = model_glass(line);
  else
    now().surface.glass = named_glass(line);
}

void Reader::conic(const Line& line) {
  now().surface.conic = line.number(1, diagnostics_).value_or(0);
}

void Reader::parameter(const Line& line) {
  const auto number = line.number(1, diagnostics_);
  const auto value = line.number(2, diagnostics_);
  if (!number || !value || *value == 0) return;
  if (!now().parameter) now().parameter = line;
  if (*number >= 1 && *number <= static_cast<double>(kEvenCoefficients))
    now().even[static_cast<std::size_t>(*number) - 1] = *value;
  else
    error(line, 1,
          fmt::format("parameter without a meaning here (got {:g}, allowed 1 to {})", *number,
                      kEvenCoefficients));
}

void Reader::stop(const Line& line) {
  if (is_object()) error(line, 0, "the object cannot be the stop");
  now().surface.stop = true;
}

// The second number tells a diameter that the user has set from one that Zemax has worked out.
void Reader::diameter(const Line& line) {
  now().semi_diameter = line.number(1, diagnostics_).value_or(0);
  if (line.text(2) == "1") now().fixed = true;
}

void Reader::clear_aperture(const Line& line) {
  const auto inner = line.number(1, diagnostics_);
  const auto outer = line.positive(2, diagnostics_);
  if (inner && *inner != 0) error(line, 1, "apertures with a hole are not understood");
  if (outer) now().surface.aperture = *outer;
}

void Reader::coating(const Line& line) {
  diagnostics_.warning(
      line.where(1),
      fmt::format("the coating {} is left out: its layers are in another file", line.text(1).value_or("")));
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
