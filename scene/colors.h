#pragma once

#include "scene/scene.h"

namespace abbe {

/// True if a film of the scene has colours and therefore a white: it has exactly three channels that measure
/// intensity, or a spectrum. Stokes components other than the intensity do not count.
[[nodiscard]] bool has_colors(const Scene& scene);

/// The observer of those colours: the standard observer that the intensity channels implement, otherwise CIE
/// 1931. The band edges [nm] are those of a spectral film or of the spectral image that the sensor views,
/// otherwise empty.
[[nodiscard]] FilmObserver film_observer_of(const Scene& scene);

}  // namespace abbe
