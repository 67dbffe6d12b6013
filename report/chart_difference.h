#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "report/image_difference.h"
#include "scene/scene.h"

namespace abbe {

/// One patch of a chart in a film and its reference, as L*a*b* relative to the white of the scene's main
/// light.
struct PatchDifference {
  std::string name;
  std::size_t pixels;  ///< Number of pixels of `image` that are averaged.
  /// Colour in the reference film, or the integrated colour without one. Nothing if the film's colours are
  /// unknown.
  std::optional<Lab> reference;
  std::optional<Lab> image;       ///< Colour in the film; nothing if the film's colours are unknown.
  std::optional<double> delta_e;  ///< Nothing without both colours; NaN if one is not finite.
};

/// Compares the first chart of a scene in `image` with the same chart in `reference`. Without a reference
/// film, it compares with the colours integrated over the patches' spectra under the scene's main light.
/// The films have channels X, Y, Z or R, G, B, interpreted by `film_colors`. One factor scales both films. It
/// equates the sum of Y over the patches of the reference film (or of `image` without one) with the
/// integrated sum.
/// The result has the patches in the order of the chart. `reference` is null without a reference film;
/// `formula` gives the differences.
/// Throws Error{input} for a scene without chart or light, for films of different observers, and if the film
/// that sets the factor is dark in all patches. Also throws the errors of `film_colors` and `read_patches`.
[[nodiscard]] std::vector<PatchDifference> compare_chart(const Scene& scene, const Image& image,
                                                         const Image* reference, DeltaE formula);

}  // namespace abbe
