#pragma once

#include <optional>
#include <string>

#include "scene/lights/light.h"
#include "spectral/colorimetry.h"

namespace abbe {

class Scene;

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

/// True if a film of the scene has colours and therefore a white: it has exactly three channels that measure
/// intensity, or a spectrum. Stokes components other than the intensity do not count.
[[nodiscard]] bool has_colors(const Scene& scene);

/// The observer of those colours: the standard observer that the intensity channels implement, otherwise CIE
/// 1931. The band edges [nm] are those of a spectral film or of the spectral image that the sensor views,
/// otherwise empty.
[[nodiscard]] FilmObserver film_observer_of(const Scene& scene);

}  // namespace abbe
