#pragma once

#include <optional>
#include <string>

#include "scene/lights/light.h"
#include "spectral/film_observer.h"

namespace abbe {

/// The light that pictures of a film display as white.
struct White {
  std::string name;                      ///< Name of a light, an illuminant or its file, or the chromaticity.
  std::string reason;                    ///< Reason for the choice.
  Chromaticity xy{};                     ///< NaN for light that the observer does not respond to.
  std::optional<Curve> spectrum = {};    ///< Of the light; nothing if the white is not a light of the scene.
  std::optional<Curve> illuminant = {};  ///< Spectrum of a named illuminant, which does not light the scene.
  bool requested = false;                ///< True if the user named it.
};

/// The white of a light: its mean emission, and the chromaticity of that for the film's observer.
[[nodiscard]] White white_of(const Light& light, const FilmObserver& film_observer, std::string reason);

}  // namespace abbe
