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

/// A reference white: the name of a light or an illuminant, or CIE chromaticity coordinates x, y in (0, 1).
struct White : schema::Located<std::variant<std::string, std::array<double, 2>>> {};
/// The form in which scene files write a reference white.
[[nodiscard]] schema::ValueType white();

}  // namespace abbe::spec

namespace abbe {

/// Names that a reference white may have, and the observer that evaluates it.
struct WhiteNames {
  FilmObserver film_observer;       ///< Observer for the chromaticity of an illuminant.
  std::vector<std::string> lights;  ///< Names of the lights; several may be equal.
  /// Reference white of the light with this index in `lights`.
  std::function<White(std::size_t)> white_of_light;
  /// Converts the name of an illuminant to one that `load_illuminant` accepts, such as the path of a file.
  /// Returns nothing after reporting an error.
  std::function<std::optional<std::string>(const schema::Located<std::string>&)> illuminant;
};

/// Builds a reference white and marks it as requested. A name is that of a light, else of an illuminant (see
/// `load_illuminant`). Reports an unknown name with the nearest known one, a name that several lights have,
/// an illuminant that cannot be read, and coordinates with x + y above 1. Returns nothing after an error.
[[nodiscard]] std::optional<White> build(const spec::White& white, const WhiteNames& names,
                                         Diagnostics& diagnostics);
/// Reads and builds a reference white. Also reports JSON of another form.
[[nodiscard]] std::optional<White> read_white(const JsonValue& json, const WhiteNames& names,
                                              Diagnostics& diagnostics);

/// Names for `build`: those of the lights of a scene, and illuminants by their own names. The result refers
/// to `lights`, which must outlive it unchanged.
[[nodiscard]] WhiteNames white_names(const std::vector<Light>& lights, const FilmObserver& film_observer);

}  // namespace abbe
