#include "description/white.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "io/schema/read.h"
#include "io/table.h"
#include "spectral/library.h"

namespace abbe {
namespace {

std::optional<White> build_chromaticity(const Chromaticity& white, const SourcePosition& where,
                                        Diagnostics& diagnostics) {
  if (white[0] + white[1] <= 1) return White{fmt::format("{},{}", white[0], white[1]), "", white};
  diagnostics.error(where,
                    fmt::format("is not a chromaticity: x + y is above 1 (got {}, {})", white[0], white[1]));
  return std::nullopt;
}

// Builds the white of a light of the scene or of an illuminant.
std::optional<White> build_named(const std::string& name, const SourcePosition& where,
                                 const WhiteNames& names, Diagnostics& diagnostics) {
  const std::vector<std::string>& lights = names.lights;
  const auto light = std::find(lights.begin(), lights.end(), name);
  if (light != lights.end()) {
    if (std::find(light + 1, lights.end(), name) == lights.end())
      return names.white_of_light(static_cast<std::size_t>(light - lights.begin()));
    diagnostics.error(where, fmt::format("several lights are called \"{}\"", name));
    return std::nullopt;
  }
  std::vector<std::string> known = table_names("illuminant");
  // Loading an illuminant gives the better message if the name may be that of one.
  if (user_table_end(name) == std::string::npos && name.find(':') == std::string::npos &&
      std::ranges::find(known, name) == known.end()) {
    known.insert(known.begin(), lights.begin(), lights.end());
    diagnostics.error(where, unknown_name("light or illuminant", name, known));
    return std::nullopt;
  }
  const std::optional<std::string> table = names.illuminant({{name}, where});
  auto illuminant = table ? load_illuminant(*table, where, diagnostics) : std::nullopt;
  if (!illuminant) return std::nullopt;
  const Chromaticity xy = chromaticity(illuminant->curve, names.film_observer);
  return White{name, "", xy, {}, std::move(illuminant->curve)};
}

}  // namespace

schema::ValueType spec::white() {
  using namespace schema;
  using Pair = std::array<double, 2>;
  return forms<White::Wrapped>("white", "a white: a name or two coordinates",
                               form<Pair>(Json::list, vector<Pair>({0, 1, true, true})),
                               form<std::string>(Json::text));
}

std::optional<White> build(const spec::White& spec, const WhiteNames& names, Diagnostics& diagnostics) {
  const auto* xy = std::get_if<std::array<double, 2>>(&spec.value);
  std::optional<White> white =
      xy != nullptr ? build_chromaticity({(*xy)[0], (*xy)[1]}, spec.where, diagnostics)
                    : build_named(std::get<std::string>(spec.value), spec.where, names, diagnostics);
  if (white) {
    white->reason = "asked for";
    white->requested = true;
  }
  return white;
}

std::optional<White> read_white(const JsonValue& json, const WhiteNames& names, Diagnostics& diagnostics) {
  const auto white_spec = schema::read<spec::White>(json, spec::white(), diagnostics);
  return white_spec ? build(*white_spec, names, diagnostics) : std::nullopt;
}

WhiteNames white_names(const std::vector<Light>& lights, const FilmObserver& film_observer) {
  WhiteNames names{film_observer,
                   {},
                   [&lights, film_observer](std::size_t i) { return white_of(lights[i], film_observer, ""); },
                   [](const schema::Located<std::string>& name) { return std::optional(name.value); }};
  for (const Light& light : lights) names.lights.push_back(light.name);
  return names;
}

}  // namespace abbe
