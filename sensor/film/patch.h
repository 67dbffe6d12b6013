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
  double highest = 0;                    ///< Highest value of all pixels, as they were exposed.
  std::size_t at_highest = 0;            ///< Pixels that have it.
  std::size_t middle_levels = 0;  ///< Distinct values of the middle half of the pixels, as they were exposed.

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
  /// A value below `saturation` per channel from which its pixels also count as saturated; empty if none.
  std::vector<std::optional<double>> clipped_at = {};

  /// The value from which a pixel of a channel counts as saturated.
  [[nodiscard]] std::optional<double> saturation_of(std::size_t channel) const {
    return channel < clipped_at.size() && clipped_at[channel] ? clipped_at[channel] : saturation;
  }
};

/// Measures the pixels that lie wholly within each outline. Throws Error{input} naming a patch that reaches
/// beyond the image or what of it was rendered, or in which a channel has no whole pixel.
[[nodiscard]] std::vector<PatchValues> measure_patches(const Image& image, const MeasuredPlanes& planes,
                                                       std::span<const PatchOutline> outlines);

/// The value of each channel at which it is clipped below the saturation that its file declares. It is the
/// highest value of its patches, if all pixels of one patch have it, but for defective ones, while others
/// have noise. Noise narrower than a step of the codes leaves patches even by chance. So the brightest patch
/// below must have wider noise, or most others some, and another channel be even at the same value. A channel
/// of which a patch reaches the value of another one is clipped there too.
[[nodiscard]] std::vector<std::optional<double>> clipping_levels(
    std::span<const std::vector<PatchChannel>> channels, std::optional<double> saturation);

/// Clipping level of each channel: a value that no more pixels of the image exceed than may be defective.
[[nodiscard]] std::vector<std::optional<double>> clipping_levels(const Image& image,
                                                                 const MeasuredPlanes& planes,
                                                                 std::span<const PatchValues> patches);

}  // namespace abbe
