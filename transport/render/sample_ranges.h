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

/// Which samples per pixel a film holds: disjoint ranges in ascending order that do not touch.
using SampleRanges = std::vector<SampleRange>;

/// Adds a range; false, and nothing done, if some of it is there already.
[[nodiscard]] bool add(SampleRanges& ranges, const SampleRange& more);

/// The first stretch of `wanted` that is not there.
[[nodiscard]] std::optional<SampleRange> first_missing(const SampleRanges& ranges, const SampleRange& wanted);

/// All stretches of `wanted` that are not there, in ascending order.
[[nodiscard]] SampleRanges missing(const SampleRanges& ranges, const SampleRange& wanted);

/// How many samples there are, and how many of them each replicate has: sample s belongs to s mod
/// `replicates`.
[[nodiscard]] std::uint64_t count(const SampleRanges& ranges);
[[nodiscard]] std::vector<std::uint64_t> count_per_replicate(const SampleRanges& ranges, int replicates);

/// Ranges as text such as "0:16,32:64", and back; nothing for any other text.
[[nodiscard]] std::string to_text(const SampleRanges& ranges);
[[nodiscard]] std::optional<SampleRanges> parse_sample_ranges(std::string_view text);

}  // namespace abbe
