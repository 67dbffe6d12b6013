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
  Crop pixels;
  SampleRanges samples;

  bool operator==(const SampledArea&) const = default;
};

/// Which samples the pixels of a film hold: disjoint areas, cut into bands across and as few as these allow,
/// from top to bottom and left to right, so that equal holdings are equal lists.
using SampledAreas = std::vector<SampledArea>;

/// Adds samples to the pixels of an area. Where some are there already, gives the first pixels and samples
/// of which that is so, and does nothing.
[[nodiscard]] std::optional<SampledArea> add(SampledAreas& areas, const SampledArea& more);

/// What `wanted` has beyond the areas.
[[nodiscard]] SampledAreas missing(const SampledAreas& areas, const SampledArea& wanted);

/// The smallest rectangle around the areas, of which there is one at least.
[[nodiscard]] Crop bounds(const SampledAreas& areas);
/// Whether `inner` lies within `outer`.
[[nodiscard]] bool contains(const Crop& outer, const Crop& inner);

/// Areas as text "x0,y0,x1,y1=0:16,32:64 ..."; and back, nothing for any other text.
[[nodiscard]] std::string to_text(const SampledAreas& areas);
[[nodiscard]] std::optional<SampledAreas> parse_sampled_areas(std::string_view text);

}  // namespace abbe
