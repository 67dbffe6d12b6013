#pragma once

#include "scene/scene.h"

namespace abbe {

/// True if a film of the scene has colours and therefore a white: it has three channels that measure
/// intensity, or a spectrum.
[[nodiscard]] bool has_colors(const Scene& scene);

/// The observer of those colours: the observer that the sensor implements, otherwise CIE 1931. A spectral
/// film, or a sensor that views a spectral image, also gives the band edges.
[[nodiscard]] FilmObserver film_observer_of(const Scene& scene);

}  // namespace abbe
