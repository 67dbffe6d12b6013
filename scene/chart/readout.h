#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "io/image.h"
#include "scene/scene.h"
#include "sensor/film/patch.h"

namespace abbe {

/// Film values of one patch of a chart: means over the pixels entirely within its inner part, as the scene's
/// camera images it.
struct PatchReading {
  std::string name;
  std::size_t pixels;
  std::vector<double> mean;  ///< Per channel, in the order requested.
  const Curve* reflectance;  ///< Reflectance of the patch; owned by the scene.
};

/// Outlines on the film of the inner part of every patch of a chart, with names CHART/PATCH. Throws
/// Error{input} for a patch outside the film.
[[nodiscard]] std::vector<PatchOutline> chart_outlines(const Scene& scene, const ChartInstance& chart);

/// Throws Error{input} unless an image has as many pixels as the scene's camera.
void require_film_of(const Scene& scene, const ChartInstance& chart, const Image& film);

/// Reads every patch of a chart from a film of the scene, without a test for occlusion. Under a mosaic each
/// channel is averaged over its own pixels. Throws Error{input}:
/// - if the film has another size than the scene's camera, or lacks a channel;
/// - if the inner part of a patch is outside the film or contains no pixel.
[[nodiscard]] std::vector<PatchReading> read_patches(const Scene& scene, const ChartInstance& chart,
                                                     const Image& film,
                                                     const std::vector<std::string>& channels);

}  // namespace abbe
