#pragma once

#include <optional>
#include <string>

#include "scene/lights/light.h"
#include "spectral/film_observer.h"

namespace abbe {

/// What pictures of a film show as white.
struct White {
  std::string name;                      ///< Of a light, an illuminant or its file, or the chromaticity.
  std::string reason;                    ///< Why it is this one.
  Chromaticity xy{};                     ///< No numbers for a light that nobody sees.
  std::optional<Curve> spectrum = {};    ///< Of the light; nothing for what lights nothing.
  std::optional<Curve> illuminant = {};  ///< That of an illuminant, which lights nothing.
  bool asked = false;                    ///< Whether it was named, not found.
};

/// The white of a light: its mean emission, and the chromaticity of that as it is seen.
[[nodiscard]] White white_of(const Light& light, const FilmObserver& film_observer, std::string reason);

}  // namespace abbe
