#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "validation/statistics/image_difference.h"

namespace abbe {

/// One patch of a chart in a film, beside what it should be: L*a*b* relative to the white of the scene's
/// light.
struct PatchDifference {
  std::string name;
  std::size_t pixels;
  // Nothing where a film's colours are not known.
  std::optional<Lab> reference;
  std::optional<Lab> image;
  std::optional<double> delta_e;
};

/// Reads the first chart of the scene out of a film of it with X, Y, Z or R, G, B, read as `film_colors` has
/// it, and compares it with that of another film, or, without one, with the integrated colours of the patches
/// under the spectrum of the scene's main light. Both are scaled by one factor, so that the sum of the
/// reference film's Y over the patches (the film's own, without one) is that of the integrated patches.
/// Throws Error{input} for a scene without chart or light, and as `read_patches`.
[[nodiscard]] std::vector<PatchDifference> compare_chart(const Scene& scene, const Image& image,
                                                         const Image* reference, DeltaE formula);

}  // namespace abbe
