#include "sensor/readout/demosaic.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "io/error.h"
#include "sensor/film/crop.h"

namespace abbe {
namespace {

struct Neighbour {
  int dx;
  int dy;
  float weight;
};

// Offsets and weights of a channel's pixels around pixel (x, y) of the pattern; only the pixel itself if it
// has the channel.
std::vector<Neighbour> neighbours(const Mosaic& mosaic, int x, int y, int channel) {
  if (mosaic.at(x, y) == channel) return {{0, 0, 1}};
  std::vector<Neighbour> around;
  const int w = mosaic.width;
  const int h = mosaic.height;
  for (int dy = 1 - h; dy < h; ++dy)
    for (int dx = 1 - w; dx < w; ++dx)
      if (mosaic.at(x + dx + w, y + dy + h) == channel)
        around.push_back({dx, dy, static_cast<float>((w - std::abs(dx)) * (h - std::abs(dy)))});
  return around;
}

/// Values of a mosaic, and the pixels that its film records. Pixels outside the crop or in gaps have no
/// value.
struct RawValues {
  int width;
  int height;
  const std::vector<float>& values;
  std::vector<bool> recorded;

  RawValues(const Image& image, const ImageChannel& plane)
      : width(image.width), height(image.height), values(plane.values), recorded(image.pixels()) {
    for (const Crop& area : recorded_areas(image))
      for (int y = area.y0; y < area.y1; ++y)
        std::fill_n(recorded.begin() + static_cast<std::ptrdiff_t>(at(area.x0, y)), area.x1 - area.x0, true);
  }

  [[nodiscard]] std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
  [[nodiscard]] bool has(int x, int y) const {
    return x >= 0 && y >= 0 && x < width && y < height && recorded[at(x, y)];
  }
};

// Weighted mean of the recorded neighbours; 0 at a pixel that the film does not record.
float weighted_mean(const RawValues& raw, int x, int y, const std::vector<Neighbour>& around) {
  if (!raw.has(x, y)) return 0;
  float sum = 0;
  float weights = 0;
  for (const Neighbour& n : around) {
    if (!raw.has(x + n.dx, y + n.dy)) continue;
    sum += n.weight * raw.values[raw.at(x + n.dx, y + n.dy)];
    weights += n.weight;
  }
  return weights > 0 ? sum / weights : 0;
}

std::vector<float> own_values(const Image& planes, const Mosaic& mosaic, const std::string& prefix,
                              std::span<const std::string> channels) {
  std::vector<const ImageChannel*> sources;
  for (const std::string& channel : channels) {
    sources.push_back(planes.find(prefix + channel));
    if (sources.back() == nullptr) throw Error(ErrorCode::input, "film", "has no plane " + prefix + channel);
  }
  std::vector<float> values;
  values.reserve(planes.pixels());
  for (int y = 0; y < planes.height; ++y)
    for (int x = 0; x < planes.width; ++x)
      values.push_back(sources[static_cast<std::size_t>(mosaic.at(x, y))]->values[values.size()]);
  return values;
}

}  // namespace

Image mosaicked(const Image& planes, const Mosaic& mosaic, std::span<const std::string> channels) {
  constexpr const char* kVariance = "Variance.";
  return {planes.width,
          planes.height,
          {{kRawPlane, own_values(planes, mosaic, "", channels)},
           {std::string(kVariance) + kRawPlane, own_values(planes, mosaic, kVariance, channels)}},
          planes.metadata};
}

Image demosaic(const Image& image, const std::string& raw, const Mosaic& mosaic,
               std::span<const std::string> channels) {
  const ImageChannel* plane = image.find(raw);
  if (plane == nullptr) throw Error(ErrorCode::input, "film", "has no plane " + raw);
  const RawValues own(image, *plane);
  Image planes{image.width, image.height, {}, image.metadata};
  for (std::size_t channel = 0; channel < channels.size(); ++channel) {
    std::vector<std::vector<Neighbour>> around;  // of each pixel of the pattern
    for (int y = 0; y < mosaic.height; ++y)
      for (int x = 0; x < mosaic.width; ++x)
        around.push_back(neighbours(mosaic, x, y, static_cast<int>(channel)));
    std::vector<float> values;
    values.reserve(image.pixels());
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        values.push_back(weighted_mean(
            own, x, y,
            around[static_cast<std::size_t>(y % mosaic.height * mosaic.width + x % mosaic.width)]));
    planes.channels.push_back({channels[channel], std::move(values)});
  }
  return planes;
}

}  // namespace abbe
