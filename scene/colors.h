#pragma once

#include "scene/scene.h"

namespace abbe {

/// Whether a film of the scene has colours, and so a white: three channels that count light, or a
/// spectrum.
[[nodiscard]] bool has_colors(const Scene& scene);

/// Who sees those colours: the observer that the sensor is, else that of 1931; of spectral films, and through
/// a sensor that looks at one, by bands.
[[nodiscard]] FilmObserver film_observer_of(const Scene& scene);

}  // namespace abbe
