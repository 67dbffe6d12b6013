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
#include "sensor/response/mosaic.h"

namespace abbe {

/// Largest fraction of black or saturated pixels that counts as defective. Hot, stuck and dead pixels occur
/// at any light; a larger fraction is due to the light.
inline constexpr double kMaxDefectiveFraction = 0.01;

/// True if `at_end` black or saturated ones among `pixels` are too many to be defective.
[[nodiscard]] constexpr bool exceeds_defects(double at_end, double pixels) {
  return at_end > kMaxDefectiveFraction * pixels;
}

/// Outline of a chart patch in an image: the corners of a convex quadrilateral in order of either sense, in
/// pixels from the top left corner, x right and y down.
struct PatchOutline {
  std::string name;
  std::array<Imath::V2d, 4> corners;
};

/// Statistics of one channel in a patch. Mean, median and deviation exclude defective black and saturated
/// pixels (`exceeds_defects`).
struct PatchChannel {
  std::size_t pixels = 0;                ///< All pixels.
  double mean = 0;                       ///< In units of the plane, like all values here.
  double median = 0;                     ///< Median by `grouped_median`.
  std::optional<double> deviation = {};  ///< Standard deviation of the pixels; nothing for a single pixel.
  std::size_t black = 0;                 ///< Number of pixels at or below the black value.
  std::size_t saturated = 0;             ///< Number of pixels at or above saturation.
  double highest = 0;                    ///< Highest value of all pixels before flat-field division.
  std::size_t at_highest = 0;            ///< Number of pixels with the highest value.
  /// Number of distinct values in the central half of the pixels, before flat-field division.
  std::size_t interquartile_levels = 0;

  /// True if there are too many black (saturated) pixels to be defective.
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

/// Planes of an image to be measured. With a mosaic there is one plane, in which each channel has its own
/// pixels.
struct MeasuredPlanes {
  std::vector<const ImageChannel*> planes;  ///< One per channel, or one for a mosaic; not owned.
  std::vector<std::string> channels;        ///< Names of the channels.
  std::optional<Mosaic> mosaic;             ///< Mosaic of the only plane, if it is one.
  std::optional<double> saturation;         ///< Lowest value of a saturated pixel.
  std::vector<Crop> rendered = {};          ///< Rendered pixels as disjoint areas; empty if all are.
  std::optional<double> black = {};         ///< Highest value of a black pixel.
  /// Planes before flat-field division, which decide what is black or saturated. Empty if they are `planes`.
  std::vector<const ImageChannel*> exposed = {};
  /// Lower saturation value of each channel, below `saturation`, if it clips there; empty if none does.
  std::vector<std::optional<double>> clipped_at = {};

  [[nodiscard]] std::optional<double> saturation_of(std::size_t channel) const {
    return channel < clipped_at.size() && clipped_at[channel] ? clipped_at[channel] : saturation;
  }
};

/// Measures the pixels that lie entirely within each outline, by patch and channel in their order. Throws
/// Error{input} with the name of the patch if it extends outside the image or its rendered areas, or contains
/// no whole pixel of a channel.
[[nodiscard]] std::vector<PatchValues> measure_patches(const Image& image, const MeasuredPlanes& planes,
                                                       std::span<const PatchOutline> outlines);

/// Value of each channel at which it clips below the `saturation` that its file declares; nothing for
/// channels that do not. `channels[k]` has the patches of channel k. The level is the highest value in them,
/// if it is below `saturation` and all pixels of one patch have it, except for defective ones, while others
/// have noise. Noise narrower than one step of the codes makes patches uniform by chance. The brightest patch
/// below must therefore have wider noise. Alternatively most patches must have some noise, and another
/// channel must be uniform at the same value. A channel clips there too if one of its patches has the
/// clipping value of another channel.
[[nodiscard]] std::vector<std::optional<double>> clipping_levels(
    std::span<const std::vector<PatchChannel>> channels, std::optional<double> saturation);

/// These levels for measured patches. A channel with more pixels above its level than are defective has none.
[[nodiscard]] std::vector<std::optional<double>> clipping_levels(const Image& image,
                                                                 const MeasuredPlanes& planes,
                                                                 std::span<const PatchValues> patches);

/// Median of grouped data. `values` must not be empty. Equal values, such as codes, are spread evenly over a
/// step that extends halfway to the neighbouring values. With a neighbour on one side only, the step is
/// symmetric. The median of codes is therefore finer than one code, like their mean. A side with so few
/// values that they may be defective (`exceeds_defects`) has no neighbour.
[[nodiscard]] double grouped_median(std::vector<double> values);

}  // namespace abbe
