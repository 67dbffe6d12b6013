#pragma once

#include <optional>
#include <string>

#include "scene/lights/light.h"
#include "spectral/colorimetry.h"

namespace abbe {

/// The light that pictures of a film display as white.
struct White {
  std::string name;    ///< Name of a light, an illuminant or its file, or the chromaticity.
  std::string reason;  ///< Reason for the choice, as text for messages.
  Chromaticity xy{};   ///< CIE x, y for the film's observer; NaN for light that it does not respond to.
  /// Emission of the light, in the unit of `Light::emission`; nothing if the white is not a light of the
  /// scene.
  std::optional<Curve> spectrum = {};
  /// Relative spectrum of a named illuminant, which does not light the scene.
  std::optional<Curve> illuminant = {};
  bool requested = false;  ///< True if the user named it.
};

/// The white of a light, with its name: its emission averaged over directions (`mean_emission`) as
/// `spectrum`, and the chromaticity of that for the film's observer. `requested` is false. `reason` is copied
/// to the result.
[[nodiscard]] White white_of(const Light& light, const FilmObserver& film_observer, std::string reason);

}  // namespace abbe
