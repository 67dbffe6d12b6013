#pragma once

#include <span>
#include <vector>

#include "spectral/colorimetry.h"

namespace abbe {

/// Observer for the colours of a film.
struct FilmObserver {
  Observer observer = Observer::cie1931;
  /// Edges of the bands of a spectral image, ascending [nm]. If empty, the observer receives the light
  /// itself.
  std::vector<double> band_edges_nm = {};
};

/// Light as the bands of an image represent it: its mean over each band, and 0 outside them.
[[nodiscard]] Curve in_bands(const Curve& light, std::span<const double> edges_nm);

/// Chromaticity of a light in the bands of the image. It is that of the light itself if the bands contain
/// none of it within `kVisibleRange`. Not finite if the observer's response to the light is zero.
[[nodiscard]] Chromaticity chromaticity(const Curve& light, const FilmObserver& film_observer);

}  // namespace abbe
