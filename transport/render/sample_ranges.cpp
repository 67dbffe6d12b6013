#include "transport/render/sample_ranges.h"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

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

// Parts of a rectangle around a hole inside it: above, below, left and right.
std::vector<Crop> around(const Crop& whole, const Crop& hole) {
  std::vector<Crop> rest;
  for (const Crop& piece :
       {Crop{whole.x0, whole.y0, whole.x1, hole.y0}, Crop{whole.x0, hole.y1, whole.x1, whole.y1},
        Crop{whole.x0, hole.y0, hole.x0, hole.y1}, Crop{hole.x1, hole.y0, whole.x1, hole.y1}})
    if (piece.x0 < piece.x1 && piece.y0 < piece.y1) rest.push_back(piece);
  return rest;
}

// Parts of a rectangle outside the areas.
std::vector<Crop> without(const Crop& whole, const SampledAreas& areas) {
  std::vector<Crop> rest{whole};
  for (const SampledArea& area : areas) {
    std::vector<Crop> next;
    for (const Crop& piece : rest)
      if (const auto hole = common_pixels(piece, area.pixels)) {
        const std::vector<Crop> pieces = around(piece, *hole);
        next.insert(next.end(), pieces.begin(), pieces.end());
      } else {
        next.push_back(piece);
      }
    rest = std::move(next);
  }
  return rest;
}

// The band y0 <= y < y1 of disjoint areas, none of which ends inside it. Areas run from left to right, and
// neighbours with equal samples are joined.
SampledAreas band(const SampledAreas& areas, int y0, int y1) {
  SampledAreas row;
  for (const SampledArea& area : areas)
    if (area.pixels.y0 <= y0 && area.pixels.y1 >= y1)
      row.push_back({{area.pixels.x0, y0, area.pixels.x1, y1}, area.samples});
  std::sort(row.begin(), row.end(), [](const auto& a, const auto& b) { return a.pixels.x0 < b.pixels.x0; });
  SampledAreas joined;
  for (SampledArea& area : row)
    if (!joined.empty() && joined.back().pixels.x1 == area.pixels.x0 && joined.back().samples == area.samples)
      joined.back().pixels.x1 = area.pixels.x1;
    else
      joined.push_back(std::move(area));
  return joined;
}

bool continues(const SampledAreas& above, const SampledAreas& below) {
  return std::equal(above.begin(), above.end(), below.begin(), below.end(), [](const auto& a, const auto& b) {
    return a.pixels.x0 == b.pixels.x0 && a.pixels.x1 == b.pixels.x1 && a.pixels.y1 == b.pixels.y0 &&
           a.samples == b.samples;
  });
}

// True if `next` may follow `before` in the list: to its right in the same band, or below.
bool follows(const Crop& before, const Crop& next) {
  const bool is_right_neighbour = next.y0 == before.y0 && next.y1 == before.y1 && next.x0 >= before.x1;
  return is_right_neighbour || next.y0 >= before.y1;
}

// Canonical list of areas for given contents.
SampledAreas in_bands(const SampledAreas& areas) {
  std::vector<int> edges;
  for (const SampledArea& area : areas) edges.insert(edges.end(), {area.pixels.y0, area.pixels.y1});
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  SampledAreas all;
  SampledAreas last;
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    SampledAreas next = band(areas, edges[i], edges[i + 1]);
    if (continues(last, next)) {
      for (SampledArea& area : last) area.pixels.y1 = edges[i + 1];
      continue;
    }
    all.insert(all.end(), last.begin(), last.end());
    last = std::move(next);
  }
  all.insert(all.end(), last.begin(), last.end());
  return all;
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

std::optional<SampledArea> add(SampledAreas& areas, const SampledArea& more) {
  SampledAreas pieces;
  for (const Crop& pixels : without(more.pixels, areas)) pieces.push_back({pixels, more.samples});
  for (const SampledArea& area : areas) {
    const auto both = common_pixels(area.pixels, more.pixels);
    if (!both) {
      pieces.push_back(area);
      continue;
    }
    SampledArea sum{*both, area.samples};
    for (const SampleRange& range : more.samples)
      if (!add(sum.samples, range)) return SampledArea{*both, {range}};
    pieces.push_back(std::move(sum));
    for (const Crop& rest : around(area.pixels, *both)) pieces.push_back({rest, area.samples});
  }
  areas = in_bands(pieces);
  return std::nullopt;
}

SampledAreas missing(const SampledAreas& areas, const SampledArea& wanted) {
  SampledAreas gaps;
  for (const Crop& pixels : without(wanted.pixels, areas)) gaps.push_back({pixels, wanted.samples});
  for (const SampledArea& area : areas) {
    const auto both = common_pixels(area.pixels, wanted.pixels);
    if (!both) continue;
    SampleRanges samples;
    for (const SampleRange& range : wanted.samples) {
      const SampleRanges more = missing(area.samples, range);
      samples.insert(samples.end(), more.begin(), more.end());
    }
    if (!samples.empty()) gaps.push_back({*both, std::move(samples)});
  }
  return in_bands(gaps);
}

Crop bounds(const SampledAreas& areas) {
  Crop all = areas.front().pixels;
  for (const auto& [c, unused] : areas)
    all = {std::min(all.x0, c.x0), std::min(all.y0, c.y0), std::max(all.x1, c.x1), std::max(all.y1, c.y1)};
  return all;
}

bool contains(const Crop& outer, const Crop& inner) {
  return common_pixels(outer, inner) == inner;
}

std::string to_text(const SampledAreas& areas) {
  std::string text;
  for (const auto& [pixels, samples] : areas)
    text += fmt::format("{}{}={}", text.empty() ? "" : " ", to_text(pixels), to_text(samples));
  return text;
}

std::optional<SampledAreas> parse_sampled_areas(std::string_view text) {
  SampledAreas areas;
  for (const std::string& word : split(text, ' ')) {
    const std::vector<std::string> sides = split(word, '=');
    const auto pixels = parse_crop(sides.front());
    const auto samples = parse_sample_ranges(sides.back());
    if (sides.size() != 2 || !pixels || !samples) return std::nullopt;
    if (!areas.empty() && !follows(areas.back().pixels, *pixels)) return std::nullopt;
    areas.push_back({*pixels, *samples});
  }
  return areas;
}

}  // namespace abbe
