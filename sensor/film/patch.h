#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Imath/ImathVec.h>

#include "io/image.h"
#include "sensor/film/crop.h"
#include "sensor/film/defective_pixels.h"
#include "sensor/response/mosaic.h"

namespace abbe {

/// Where a patch of a chart lies in an image: the corners of a convex quadrilateral [pixels from the top left
/// corner], in the order of going around it.
struct PatchOutline {
  std::string name;
  std::array<Imath::V2d, 4> corners;
};

/// What an image holds of a patch in one channel. Black and saturated pixels are left out of mean, median and
/// deviation where there are so few of them that they are taken for defective (`exceeds_defects`).
struct PatchChannel {
  std::size_t pixels = 0;  ///< All of them.
  double mean = 0;
  double median = 0;                     ///< As `grouped_median` has it.
  std::optional<double> deviation = {};  ///< Standard deviation of the pixels; nothing of a single one.
  std::size_t black = 0;                 ///< Pixels at or below black.
  std::size_t saturated = 0;             ///< Pixels at or above saturation.

  /// Whether more pixels are there than defective ones.
  [[nodiscard]] bool is_black() const {
    return exceeds_defects(static_cast<double>(black), static_cast<double>(pixels));
  }
  [[nodiscard]] bool is_saturated() const {
    return exceeds_defects(static_cast<double>(saturated), static_cast<double>(pixels));
  }
};
struct PatchValues {
  std::string name;
  std::vector<PatchChannel> channels;
};

/// The planes of an image that are measured; with a mosaic the only one, of whose pixels each channel has its
/// own.
struct MeasuredPlanes {
  std::vector<const ImageChannel*> planes;
  std::vector<std::string> channels;
  std::optional<Mosaic> mosaic;
  std::optional<double> saturation;  ///< Values from which a pixel counts as saturated.
  std::vector<Crop> rendered = {};   ///< The pixels that hold anything, as disjoint areas; of none all do.
  std::optional<double> black = {};  ///< Values up to which a pixel counts as black.
  /// The planes before they were divided by a flat, which tell what is black or saturated; of none `planes`
  /// do.
  std::vector<const ImageChannel*> exposed = {};
};

/// Measures the pixels that lie wholly within each outline. Throws Error{input} naming a patch that reaches
/// beyond the image or what of it was rendered, or in which a channel has no whole pixel.
[[nodiscard]] std::vector<PatchValues> measure_patches(const Image& image, const MeasuredPlanes& planes,
                                                       std::span<const PatchOutline> outlines);

}  // namespace abbe
