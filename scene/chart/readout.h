#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "io/image.h"
#include "scene/scene.h"
#include "sensor/film/patch.h"

namespace abbe {

/// Film values of one patch of a chart: means over the pixels entirely within its inner part, as the scene's
/// camera images it. The inner part is the central 70 % of each edge.
struct PatchReading {
  std::string name;          ///< Name within the chart, without the chart's name.
  std::size_t pixels;        ///< Number of pixels read; under a mosaic the sum over the channels.
  std::vector<double> mean;  ///< Film value per channel, in the order requested.
  const Curve* reflectance;  ///< Spectral reflectance of the patch; owned by the scene.
};

/// Outlines on the film [pixels] of the inner part of every patch of a chart, in the chart's order, with
/// names CHART/PATCH. They are images at 550 nm and time 0. Throws Error{input} for a patch whose inner part
/// is not entirely on the film.
[[nodiscard]] std::vector<PatchOutline> chart_outlines(const Scene& scene, const ChartInstance& chart);

/// Throws Error{input}, which names the chart, unless the film has the width and height of the scene's
/// camera.
void require_film_of(const Scene& scene, const ChartInstance& chart, const Image& film);

/// Reads every patch of a chart from a film of the scene, in the chart's order, without a test for occlusion.
/// Under a mosaic each channel is averaged over its own pixels. Throws Error{input}:
/// - if the film has another size than the scene's camera, or lacks a channel;
/// - if the inner part of a patch is outside the film or contains no pixel.
[[nodiscard]] std::vector<PatchReading> read_patches(const Scene& scene, const ChartInstance& chart,
                                                     const Image& film,
                                                     const std::vector<std::string>& channels);

}  // namespace abbe
