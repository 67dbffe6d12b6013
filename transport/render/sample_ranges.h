#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sensor/film/crop.h"

namespace abbe {

/// Samples first <= s < last of every pixel.
struct SampleRange {
  std::uint64_t first;
  std::uint64_t last;

  bool operator==(const SampleRange&) const = default;
};

/// Samples per pixel that a film holds: disjoint ranges in ascending order, with a gap between neighbours.
using SampleRanges = std::vector<SampleRange>;

/// Adds a range that is not empty, and joins neighbours without a gap. Returns false and changes nothing if
/// `ranges` has some of its samples already.
[[nodiscard]] bool add(SampleRanges& ranges, const SampleRange& more);

/// The first range of `wanted` that is missing in `ranges`; empty if there is none.
[[nodiscard]] std::optional<SampleRange> first_missing(const SampleRanges& ranges, const SampleRange& wanted);

/// All ranges of `wanted` that are missing in `ranges`, in ascending order.
[[nodiscard]] SampleRanges missing(const SampleRanges& ranges, const SampleRange& wanted);

/// Number of samples in all ranges.
[[nodiscard]] std::uint64_t count(const SampleRanges& ranges);
/// Number of samples of each replicate: sample s belongs to replicate s mod `replicates`.
[[nodiscard]] std::vector<std::uint64_t> count_per_replicate(const SampleRanges& ranges, int replicates);

/// Text of ranges, such as "0:16,32:64".
[[nodiscard]] std::string to_text(const SampleRanges& ranges);
/// Inverse of `to_text` for a list that is not empty; nothing for any other text, and for the empty one.
[[nodiscard]] std::optional<SampleRanges> parse_sample_ranges(std::string_view text);

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
