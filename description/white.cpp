#include "description/white.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "io/object_reader.h"
#include "io/table.h"
#include "spectral/library.h"

namespace abbe {
namespace {

constexpr const char* kAsked = "asked for";

std::optional<White> read_chromaticity(const JsonValue& json, Diagnostics& diagnostics) {
  const auto xy = read_numbers(json, 2, {0, 1, true, true}, diagnostics);
  if (!xy) return std::nullopt;
  const Chromaticity white{(*xy)[0], (*xy)[1]};
  if (white[0] + white[1] <= 1) return White{fmt::format("{},{}", white[0], white[1]), kAsked, white};
  diagnostics.error(json.where,
                    fmt::format("is no chromaticity: x + y is above 1 (got {}, {})", white[0], white[1]));
  return std::nullopt;
}

// Whether the library of illuminants has more to say of a name than that it does not know it.
bool may_be_illuminant(const std::string& name, const std::vector<std::string>& illuminants) {
  return name.find(".csv") != std::string::npos || name.find(':') != std::string::npos ||
         std::find(illuminants.begin(), illuminants.end(), name) != illuminants.end();
}

}  // namespace

std::optional<White> read_white(const JsonValue& json, const WhiteNames& names, Diagnostics& diagnostics) {
  if (std::holds_alternative<JsonValue::Array>(json.value)) return read_chromaticity(json, diagnostics);
  const std::optional<std::string> name = read_string(json, diagnostics);
  if (!name) return std::nullopt;
  const std::vector<std::string>& lights = names.lights;
  const auto light = std::find(lights.begin(), lights.end(), *name);
  if (light != lights.end()) {
    if (std::find(light + 1, lights.end(), *name) == lights.end()) {
      White white = names.white_of_light(static_cast<std::size_t>(light - lights.begin()));
      white.reason = kAsked;
      return white;
    }
    diagnostics.error(json.where, fmt::format("several lights are called \"{}\"", *name));
    return std::nullopt;
  }
  std::vector<std::string> known = table_names("illuminant");
  if (!may_be_illuminant(*name, known)) {
    known.insert(known.begin(), lights.begin(), lights.end());
    diagnostics.error(json.where, unknown_name("light or illuminant", *name, known));
    return std::nullopt;
  }
  const std::optional<std::string> table = names.illuminant(json);
  const auto illuminant = table ? load_illuminant(*table, json.where, diagnostics) : std::nullopt;
  if (!illuminant) return std::nullopt;
  return White{*name, kAsked, chromaticity(illuminant->curve)};
}

WhiteNames white_names(const std::vector<Light>& lights, Diagnostics& diagnostics) {
  WhiteNames names{{},
                   [&lights](std::size_t i) { return white_of(lights[i], ""); },
                   [&diagnostics](const JsonValue& name) { return read_string(name, diagnostics); }};
  for (const Light& light : lights) names.lights.push_back(light.name);
  return names;
}

}  // namespace abbe
