#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "io/schema/fields.h"
#include "scene/white.h"

namespace abbe::spec {

/// The name of a light or an illuminant, or chromaticity coordinates.
struct White : schema::Located<std::variant<std::string, std::array<double, 2>>> {};
[[nodiscard]] schema::Kind white();

}  // namespace abbe::spec

namespace abbe {

/// What a white may be named by, and who sees it.
struct WhiteNames {
  FilmObserver film_observer;
  std::vector<std::string> lights;
  std::function<White(std::size_t)> white_of_light;  ///< Of one of them.
  /// A name as `load_illuminant` takes it, such as where a file lies; nothing after an error.
  std::function<std::optional<std::string>(const schema::Located<std::string>&)> illuminant;
};

/// The white that is said; reports as `read_white` does.
[[nodiscard]] std::optional<White> build(const spec::White& white, const WhiteNames& names,
                                         Diagnostics& diagnostics);
/// Reads a white: the name of a light, or else of an illuminant (see `load_illuminant`), or chromaticity
/// coordinates [x, y]. Reports an unknown name with the nearest, and one that several lights have.
[[nodiscard]] std::optional<White> read_white(const JsonValue& json, const WhiteNames& names,
                                              Diagnostics& diagnostics);

/// The names of a scene's lights, and of illuminants as they are.
[[nodiscard]] WhiteNames white_names(const std::vector<Light>& lights, const FilmObserver& film_observer);

}  // namespace abbe
