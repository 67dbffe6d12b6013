#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "validation/statistics/image_difference.h"

namespace abbe {

/// One patch of a chart in a film and its reference, as L*a*b* relative to the white of the scene's light.
struct PatchDifference {
  std::string name;
  std::size_t pixels;
  // Empty if the colours of a film are unknown.
  std::optional<Lab> reference;
  std::optional<Lab> image;
  std::optional<double> delta_e;
};

/// Compares the first chart of a scene in `image` with the same chart in `reference`. Without a reference
/// film, it compares with the colours integrated over the patches' spectra under the scene's main light.
/// The films have channels X, Y, Z or R, G, B, interpreted by `film_colors`. One factor scales the films. It
/// equates the sum of Y over the patches of the reference film (or of `image` without one) with the
/// integrated sum.
/// Throws Error{input} for a scene without chart or light, for films of different observers, and the errors
/// of `read_patches`.
[[nodiscard]] std::vector<PatchDifference> compare_chart(const Scene& scene, const Image& image,
                                                         const Image* reference, DeltaE formula);

}  // namespace abbe
