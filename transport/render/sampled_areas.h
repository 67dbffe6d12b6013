#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sensor/film/crop.h"
#include "transport/render/sample_ranges.h"

namespace abbe {

/// Pixels that hold the same samples.
struct SampledArea {
  Crop pixels;           ///< Rectangle of pixels of the whole film.
  SampleRanges samples;  ///< Samples that each of these pixels holds.

  bool operator==(const SampledArea&) const = default;
};

/// Samples that the pixels of a film hold: disjoint areas from top to bottom and left to right, cut into the
/// fewest possible horizontal bands. Equal contents give equal lists.
using SampledAreas = std::vector<SampledArea>;

/// Adds samples to the pixels of an area. If some pixels have some of the samples already, changes nothing
/// and returns the first such pixels and samples.
[[nodiscard]] std::optional<SampledArea> add(SampledAreas& areas, const SampledArea& more);

/// Samples of `wanted` that its pixels lack in `areas`; empty if they lack none.
[[nodiscard]] SampledAreas missing(const SampledAreas& areas, const SampledArea& wanted);

/// The smallest rectangle around the areas; `areas` must not be empty.
[[nodiscard]] Crop bounds(const SampledAreas& areas);
/// True if `inner` lies within `outer`.
[[nodiscard]] bool contains(const Crop& outer, const Crop& inner);

/// Text of areas, "x0,y0,x1,y1=0:16,32:64 ...": corners of each rectangle, x1 and y1 excluded, and its
/// samples.
[[nodiscard]] std::string to_text(const SampledAreas& areas);
/// Inverse of `to_text` for a list that is not empty; nothing for any other text, and for the empty one.
[[nodiscard]] std::optional<SampledAreas> parse_sampled_areas(std::string_view text);

}  // namespace abbe
