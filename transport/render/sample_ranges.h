#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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

}  // namespace abbe
