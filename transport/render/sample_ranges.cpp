#include "transport/render/sample_ranges.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "io/text.h"

namespace abbe {
namespace {

std::optional<std::uint64_t> parse_count(std::string_view text) {
  std::uint64_t count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(count) : std::nullopt;
}

// Number of samples before `end` that belong to one replicate.
std::uint64_t count_before(std::uint64_t end, std::uint64_t replicate, std::uint64_t replicates) {
  return (end + replicates - 1 - replicate) / replicates;
}

}  // namespace

bool add(SampleRanges& ranges, const SampleRange& more) {
  const auto next = std::partition_point(ranges.begin(), ranges.end(),
                                         [&more](const SampleRange& r) { return r.last <= more.first; });
  if (next != ranges.end() && next->first < more.last) return false;
  auto added = ranges.insert(next, more);
  if (added + 1 != ranges.end() && added[1].first == added->last) {
    added->last = added[1].last;
    added = ranges.erase(added + 1) - 1;
  }
  if (added != ranges.begin() && added[-1].last == added->first) {
    added[-1].last = added->last;
    ranges.erase(added);
  }
  return true;
}

std::optional<SampleRange> first_missing(const SampleRanges& ranges, const SampleRange& wanted) {
  SampleRange missing = wanted;
  for (const SampleRange& range : ranges) {
    if (range.last <= missing.first) continue;
    if (range.first > missing.first) {
      missing.last = std::min(missing.last, range.first);
      break;
    }
    missing.first = range.last;
  }
  return missing.first < missing.last ? std::optional(missing) : std::nullopt;
}

SampleRanges missing(const SampleRanges& ranges, const SampleRange& wanted) {
  SampleRanges gaps;
  SampleRange rest = wanted;
  while (const auto gap = first_missing(ranges, rest)) {
    gaps.push_back(*gap);
    rest.first = gap->last;
  }
  return gaps;
}

std::uint64_t count(const SampleRanges& ranges) {
  return count_per_replicate(ranges, 1).front();
}

std::vector<std::uint64_t> count_per_replicate(const SampleRanges& ranges, int replicates) {
  std::vector<std::uint64_t> counts(static_cast<std::size_t>(replicates), 0);
  for (const SampleRange& range : ranges)
    for (std::size_t r = 0; r < counts.size(); ++r)
      counts[r] += count_before(range.last, r, counts.size()) - count_before(range.first, r, counts.size());
  return counts;
}

std::string to_text(const SampleRanges& ranges) {
  std::string text;
  for (const SampleRange& range : ranges)
    text += fmt::format("{}{}:{}", text.empty() ? "" : ",", range.first, range.last);
  return text;
}

std::optional<SampleRanges> parse_sample_ranges(std::string_view text) {
  SampleRanges ranges;
  for (const std::string& piece : split(text, ',')) {
    const std::vector<std::string> ends = split(piece, ':');
    const auto first = parse_count(ends.front());
    const auto last = parse_count(ends.back());
    if (ends.size() != 2 || !first || !last || *first >= *last || !add(ranges, {*first, *last}))
      return std::nullopt;
  }
  return ranges;
}

}  // namespace abbe
