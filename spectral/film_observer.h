#pragma once

#include <span>
#include <vector>

#include "spectral/colorimetry.h"

namespace abbe {

/// Who sees the colours of a film.
struct FilmObserver {
  Observer observer = Observer::cie1931;
  /// Ends of the bands that a spectral image has of light, ascending [nm]; without any, light itself is seen.
  std::vector<double> band_edges_nm = {};
};

/// A light of which an image has bands alone: its mean over each, and nothing beyond.
[[nodiscard]] Curve in_bands(const Curve& light, std::span<const double> edges_nm);

/// Chromaticity of a light in the bands of the image, or of the light itself if the bands hold none of it
/// within `kVisibleRange`; not finite for a light that the observer does not see.
[[nodiscard]] Chromaticity chromaticity(const Curve& light, const FilmObserver& film_observer);

}  // namespace abbe
