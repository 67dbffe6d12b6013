#pragma once

#include <span>
#include <vector>

#include "spectral/colorimetry.h"

namespace abbe {

/// Observer for the colours of a film.
struct FilmObserver {
  Observer observer = Observer::cie1931;
  /// Edges of the bands of a spectral image, strictly ascending [nm], one more than bands. If empty, the
  /// observer receives the light itself.
  std::vector<double> band_edges_nm = {};
};

/// Light as the bands of an image represent it: its mean over each band, and 0 outside them. `edges_nm` has
/// at least two elements. Throws Error{internal} unless they ascend strictly.
[[nodiscard]] Curve in_bands(const Curve& light, std::span<const double> edges_nm);

/// Chromaticity of a light in the bands of the image. It is that of the light itself if the bands contain
/// none of it within `kVisibleRange`. NaN if the observer's response to the light is zero. Throws like
/// `in_bands` and `color_matching`.
[[nodiscard]] Chromaticity chromaticity(const Curve& light, const FilmObserver& film_observer);

}  // namespace abbe
