#include "sensor/film/patch.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "io/error.h"

namespace abbe {

namespace {

// True if a point is on the inner side of every edge.
bool contains(const PatchOutline& outline, const Imath::V2d& point) {
  int left = 0;
  for (std::size_t i = 0; i < outline.corners.size(); ++i) {
    const Imath::V2d edge = outline.corners[(i + 1) % outline.corners.size()] - outline.corners[i];
    left += edge.cross(point - outline.corners[i]) >= 0 ? 1 : 0;
  }
  return left == 0 || left == static_cast<int>(outline.corners.size());
}

bool contains_pixel(const PatchOutline& outline, int x, int y) {
  const Imath::V2d corner(x, y);
  return contains(outline, corner) && contains(outline, corner + Imath::V2d(1, 0)) &&
         contains(outline, corner + Imath::V2d(0, 1)) && contains(outline, corner + Imath::V2d(1, 1));
}

struct Pixel {
  int x, y;
};

// True if disjoint areas cover all pixels of a box.
bool cover(const std::vector<Crop>& areas, const Imath::V2d& low, const Imath::V2d& high) {
  const auto common = [](double from, double to, int first, int last) {
    return std::max(0.0, std::min<double>(to, last) - std::max<double>(from, first));
  };
  double without = std::max(1.0, high.x - low.x) * std::max(1.0, high.y - low.y);
  for (const Crop& area : areas)
    without -= common(low.x, high.x, area.x0, area.x1) * common(low.y, high.y, area.y0, area.y1);
  return without <= 0;
}

std::string edges_of(const std::vector<Crop>& areas) {
  std::string text;
  for (const Crop& area : areas)
    text += fmt::format("{}[{}, {}] and [{}, {}]", text.empty() ? "" : " or ", area.x0, area.x1, area.y0,
                        area.y1);
  return text;
}

std::vector<Pixel> pixels_in(const PatchOutline& outline, const std::vector<Crop>& areas,
                             const char* area_name) {
  const auto [left, right] = std::ranges::minmax_element(outline.corners, {}, &Imath::V2d::x);
  const auto [top, bottom] = std::ranges::minmax_element(outline.corners, {}, &Imath::V2d::y);
  if (!cover(areas, {std::floor(left->x), std::floor(top->y)}, {std::ceil(right->x), std::ceil(bottom->y)}))
    throw Error(ErrorCode::input, outline.name,
                fmt::format("its measured area extends outside {} (got x in [{:.5g}, {:.5g}], y in [{:.5g}, "
                            "{:.5g}], allowed {})",
                            area_name, left->x, right->x, top->y, bottom->y, edges_of(areas)));
  std::vector<Pixel> pixels;
  for (int y = static_cast<int>(top->y); y < static_cast<int>(std::ceil(bottom->y)); ++y)
    for (int x = static_cast<int>(left->x); x < static_cast<int>(std::ceil(right->x)); ++x)
      if (contains_pixel(outline, x, y)) pixels.push_back({x, y});
  return pixels;
}

// Sets mean and deviation of `values`, which must not be empty.
void average(const std::vector<double>& values, PatchChannel& channel) {
  const auto count = static_cast<double>(values.size());
  channel.mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  double squares = 0;
  for (const double value : values) squares += (value - channel.mean) * (value - channel.mean);
  if (count > 1) channel.deviation = std::sqrt(squares / (count - 1));
}

// Sets the highest value and the number of distinct values in the central half of the pixels.
void describe_spread(std::vector<double> values, PatchChannel& channel) {
  std::sort(values.begin(), values.end());
  channel.highest = values.back();
  channel.at_highest = static_cast<std::size_t>(
      values.end() - std::lower_bound(values.begin(), values.end(), channel.highest));
  const auto quarter = static_cast<std::ptrdiff_t>(values.size() / 4);
  const auto central_end = std::unique(values.begin() + quarter, values.end() - quarter);
  channel.interquartile_levels = static_cast<std::size_t>(central_end - (values.begin() + quarter));
}

// True if all pixels have the same value, except for defective ones. Requires so many pixels that noise wider
// than a step is unlikely to make them equal.
bool is_even(const PatchChannel& patch) {
  constexpr std::size_t kMinPixels = 16;
  return patch.pixels >= kMinPixels && !exceeds_defects(static_cast<double>(patch.pixels - patch.at_highest),
                                                        static_cast<double>(patch.pixels));
}

// Measures the given pixels of a channel in its plane.
PatchChannel measure(int width, const MeasuredPlanes& planes, std::size_t channel,
                     const std::vector<Pixel>& pixels) {
  const std::size_t plane = planes.mosaic ? 0 : channel;
  const std::optional<double> saturation = planes.saturation_of(channel);
  const ImageChannel& measured = *planes.planes[plane];
  const ImageChannel& exposed = planes.exposed.empty() ? measured : *planes.exposed[plane];
  const auto value = [width](const ImageChannel& channel, const Pixel& pixel) {
    return static_cast<double>(
        channel.values[static_cast<std::size_t>(pixel.y) * static_cast<std::size_t>(width) +
                       static_cast<std::size_t>(pixel.x)]);
  };
  const auto is_black = [&](const Pixel& pixel) {
    return planes.black && value(exposed, pixel) <= *planes.black;
  };
  const auto is_saturated = [&](const Pixel& pixel) {
    return saturation && value(exposed, pixel) >= *saturation;
  };
  PatchChannel result{.pixels = pixels.size()};
  result.black = static_cast<std::size_t>(std::count_if(pixels.begin(), pixels.end(), is_black));
  result.saturated = static_cast<std::size_t>(std::count_if(pixels.begin(), pixels.end(), is_saturated));
  std::vector<double> sound;
  std::vector<double> all;
  for (const Pixel& pixel : pixels) all.push_back(value(exposed, pixel));
  describe_spread(std::move(all), result);
  for (const Pixel& pixel : pixels) {
    const bool is_defective =
        (is_black(pixel) && !result.is_black()) || (is_saturated(pixel) && !result.is_saturated());
    if (!is_defective) sound.push_back(value(measured, pixel));
  }
  average(sound, result);
  result.median = grouped_median(std::move(sound));
  return result;
}

double highest_of(std::span<const PatchChannel> patches) {
  double highest = -std::numeric_limits<double>::infinity();
  for (const PatchChannel& patch : patches) highest = std::max(highest, patch.highest);
  return highest;
}

// Highest value of a channel that clips: all pixels of one patch have it, while lower patches have noise.
// Either the noise of the brightest of these is wider than a step of the codes, or most of them have noise.
struct EvenTop {
  std::optional<double> level;
  bool is_wide = false;  // True if the noise is wider than a step.
};
EvenTop even_top(std::span<const PatchChannel> patches, std::optional<double> saturation) {
  constexpr std::size_t kWideLevels = 3;  // in half of the pixels: a deviation of at least 0.75 steps
  const double highest = highest_of(patches);
  if (saturation && highest >= *saturation) return {};
  bool is_even_there = false;
  const PatchChannel* below = nullptr;
  std::size_t even = 0;
  std::size_t uneven = 0;
  for (const PatchChannel& patch : patches) {
    is_even_there = is_even_there || (patch.highest == highest && is_even(patch));
    if (patch.highest == highest) continue;
    ++(is_even(patch) ? even : uneven);
    if (below == nullptr || patch.highest > below->highest) below = &patch;
  }
  if (!is_even_there || below == nullptr) return {};
  const bool is_wide = below->interquartile_levels >= kWideLevels;
  return is_wide || uneven > even ? EvenTop{highest, is_wide} : EvenTop{};
}

}  // namespace

std::vector<PatchValues> measure_patches(const Image& image, const MeasuredPlanes& planes,
                                         std::span<const PatchOutline> outlines) {
  const Crop all{0, 0, image.width, image.height};
  const std::vector<Crop> areas = planes.rendered.empty() ? std::vector{all} : planes.rendered;
  const char* area_name = areas.front() == all ? "the film" : "the rendered pixels";
  std::vector<PatchValues> patches;
  for (const PatchOutline& outline : outlines) {
    const std::vector<Pixel> pixels = pixels_in(outline, areas, area_name);
    PatchValues patch{outline.name, {}};
    for (std::size_t k = 0; k < planes.channels.size(); ++k) {
      std::vector<Pixel> own;
      std::copy_if(pixels.begin(), pixels.end(), std::back_inserter(own), [&](const Pixel& pixel) {
        return !planes.mosaic || planes.mosaic->at(pixel.x, pixel.y) == static_cast<int>(k);
      });
      if (own.empty())
        throw Error(
            ErrorCode::input, outline.name,
            fmt::format("its measured area contains no whole pixel{}: increase the resolution of the film",
                        planes.mosaic ? " of channel " + planes.channels[k] : ""));
      patch.channels.push_back(measure(image.width, planes, k, own));
    }
    patches.push_back(std::move(patch));
  }
  return patches;
}

std::vector<std::optional<double>> clipping_levels(std::span<const std::vector<PatchChannel>> channels,
                                                   std::optional<double> saturation) {
  std::vector<EvenTop> tops;
  for (const std::vector<PatchChannel>& patches : channels) tops.push_back(even_top(patches, saturation));
  std::vector<double> clipped;
  for (const EvenTop& top : tops) {
    const auto same = std::count_if(tops.begin(), tops.end(), [&](const EvenTop& other) {
      return top.level && other.level == top.level;
    });
    if (top.level && (top.is_wide || same > 1)) clipped.push_back(*top.level);
  }
  std::vector<std::optional<double>> levels;
  for (const std::vector<PatchChannel>& patches : channels) {
    const double highest = highest_of(patches);
    const bool is_clipped = std::find(clipped.begin(), clipped.end(), highest) != clipped.end();
    levels.push_back(is_clipped ? std::optional(highest) : std::nullopt);
  }
  return levels;
}

std::vector<std::optional<double>> clipping_levels(const Image& image, const MeasuredPlanes& planes,
                                                   std::span<const PatchValues> patches) {
  std::vector<std::vector<PatchChannel>> channels(planes.channels.size());
  for (const PatchValues& patch : patches)
    for (std::size_t k = 0; k < channels.size(); ++k) channels[k].push_back(patch.channels[k]);
  std::vector<std::optional<double>> levels = clipping_levels(channels, planes.saturation);
  for (std::size_t k = 0; k < channels.size(); ++k) {
    std::optional<double>& level = levels[k];
    if (!level) continue;
    const auto& all = planes.exposed.empty() ? planes.planes : planes.exposed;
    const std::vector<float>& values = all[planes.mosaic ? 0 : k]->values;
    double pixels = 0;
    double above = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const int x = static_cast<int>(i % static_cast<std::size_t>(image.width));
      const int y = static_cast<int>(i / static_cast<std::size_t>(image.width));
      if (planes.mosaic && planes.mosaic->at(x, y) != static_cast<int>(k)) continue;
      pixels += 1;
      above += static_cast<double>(values[i]) > *level ? 1 : 0;
    }
    if (exceeds_defects(above, pixels)) level.reset();
  }
  return levels;
}

double grouped_median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const double value = values[values.size() / 2];
  const auto [first, last] = std::equal_range(values.begin(), values.end(), value);
  // Extends the step to both sides. A few outliers are defective pixels and no neighbouring code.
  const auto is_step = [&](auto from, auto to) {
    return exceeds_defects(static_cast<double>(std::distance(from, to)), static_cast<double>(values.size()));
  };
  const bool has_below = is_step(values.begin(), first);
  const bool has_above = is_step(last, values.end());
  if (!has_below && !has_above) return value;
  double below = has_below ? (value - *(first - 1)) / 2 : 0;
  double above = has_above ? (*last - value) / 2 : 0;
  if (!has_below) below = above;
  if (!has_above) above = below;
  // Position of the median in the step, from -1 to 1 around its center.
  const double half = static_cast<double>(values.size()) / 2 - static_cast<double>(first - values.begin());
  const double position = 2 * half / static_cast<double>(last - first) - 1;
  return value + position * (position < 0 ? below : above);
}

}  // namespace abbe
