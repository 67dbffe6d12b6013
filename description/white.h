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

/// A reference white: the name of a light or an illuminant, or chromaticity coordinates.
struct White : schema::Located<std::variant<std::string, std::array<double, 2>>> {};
[[nodiscard]] schema::ValueType white();

}  // namespace abbe::spec

namespace abbe {

/// Names that a reference white may have, and the observer that evaluates it.
struct WhiteNames {
  FilmObserver film_observer;
  std::vector<std::string> lights;
  std::function<White(std::size_t)>
      white_of_light;  ///< Reference white of the light with this index in `lights`.
  /// Converts a name to one that `load_illuminant` accepts, such as the path of a file. Nothing after an
  /// error.
  std::function<std::optional<std::string>(const schema::Located<std::string>&)> illuminant;
};

/// Builds a reference white, with the diagnostics of `read_white`.
[[nodiscard]] std::optional<White> build(const spec::White& white, const WhiteNames& names,
                                         Diagnostics& diagnostics);
/// Reads a reference white: the name of a light, else of an illuminant (see `load_illuminant`), or
/// chromaticity coordinates [x, y]. Reports an unknown name with the nearest known one, and a name that
/// several lights have.
[[nodiscard]] std::optional<White> read_white(const JsonValue& json, const WhiteNames& names,
                                              Diagnostics& diagnostics);

/// Names for `build`: those of the lights of a scene, and illuminants by their own names. The result refers
/// to `lights`.
[[nodiscard]] WhiteNames white_names(const std::vector<Light>& lights, const FilmObserver& film_observer);

}  // namespace abbe
