#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "io/image.h"
#include "scene/scene.h"
#include "sensor/film/patch.h"

namespace abbe {

/// What a film holds of one patch of a chart: means over the pixels that lie wholly within its middle, seen
/// through the scene's camera.
struct PatchReading {
  std::string name;
  std::size_t pixels;
  std::vector<double> mean;  ///< Channel by channel, in the order asked for.
  const Curve* reflectance;  ///< Of the patch, owned by the scene.
};

/// Where the camera of the scene sees the middle of every patch of a chart, named CHART/PATCH. Throws
/// Error{input} for a patch that it does not see.
[[nodiscard]] std::vector<PatchOutline> chart_outlines(const Scene& scene, const ChartInstance& chart);

/// Throws Error{input} unless an image has as many pixels as the scene's camera.
void require_film_of(const Scene& scene, const ChartInstance& chart, const Image& film);

/// Reads every patch of a chart from a film of the scene, whether anything hides it or not; under a mosaic
/// each channel of its own pixels. Throws
/// Error{input} when the film's size is not the scene's, when it lacks a channel, and when the middle of a
/// patch is beyond the film or holds no pixel.
[[nodiscard]] std::vector<PatchReading> read_patches(const Scene& scene, const ChartInstance& chart,
                                                     const Image& film,
                                                     const std::vector<std::string>& channels);

}  // namespace abbe
