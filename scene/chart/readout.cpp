#include "scene/chart/readout.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace abbe {
namespace {

// Of a patch's edges; what is nearer to its rim may be blurred by the lens.
constexpr double kMiddle = 0.7;
constexpr Imath::V2f kLensCentre{0.5F, 0.5F};
constexpr float kMiddleNm = 550;  // at which a patch is looked for

using Outline = std::array<Imath::V2f, 4>;

// The corners of a patch's middle on the film, in the order of going around.
std::optional<Outline> project(const Camera& camera, const Quad& quad) {
  constexpr double kLow = (1 - kMiddle) / 2;
  constexpr double kHigh = 1 - kLow;
  constexpr std::array<std::array<double, 2>, 4> kCorners{
      {{kLow, kLow}, {kHigh, kLow}, {kHigh, kHigh}, {kLow, kHigh}}};
  Outline outline;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Imath::V3d point = quad.corner + quad.edge_u * kCorners[i][0] + quad.edge_v * kCorners[i][1];
    const auto seen = sample_towards(camera, Imath::V3f(point), kLensCentre, SampledSpectrum(kMiddleNm), 0);
    if (!seen) return std::nullopt;
    outline[i] = seen->film;
  }
  return outline;
}

// Whether a point is on the inner side of every edge; a projected parallelogram is convex.
bool contains(const Outline& outline, Imath::V2f point) {
  int left = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Imath::V2f edge = outline[(i + 1) % outline.size()] - outline[i];
    left += edge.cross(point - outline[i]) >= 0 ? 1 : 0;
  }
  return left == 0 || left == static_cast<int>(outline.size());
}

bool holds_pixel(const Outline& outline, int x, int y) {
  const Imath::V2f corner(static_cast<float>(x), static_cast<float>(y));
  return contains(outline, corner) && contains(outline, corner + Imath::V2f(1, 0)) &&
         contains(outline, corner + Imath::V2f(0, 1)) && contains(outline, corner + Imath::V2f(1, 1));
}

std::vector<std::size_t> pixels_in(const Outline& outline, const Image& film) {
  const auto by_x = [](const Imath::V2f& a, const Imath::V2f& b) { return a.x < b.x; };
  const auto by_y = [](const Imath::V2f& a, const Imath::V2f& b) { return a.y < b.y; };
  const auto [left, right] = std::minmax_element(outline.begin(), outline.end(), by_x);
  const auto [top, bottom] = std::minmax_element(outline.begin(), outline.end(), by_y);
  std::vector<std::size_t> pixels;
  for (int y = static_cast<int>(top->y); y < std::min(film.height, static_cast<int>(bottom->y) + 1); ++y)
    for (int x = static_cast<int>(left->x); x < std::min(film.width, static_cast<int>(right->x) + 1); ++x)
      if (holds_pixel(outline, x, y))
        pixels.push_back(static_cast<std::size_t>(y) * static_cast<std::size_t>(film.width) +
                         static_cast<std::size_t>(x));
  return pixels;
}

const ImageChannel& channel_of(const Image& film, const std::string& name) {
  if (const ImageChannel* channel = film.find(name)) return *channel;
  throw Error(ErrorCode::input, "", fmt::format("the film has no channel {}", name));
}

double mean_over(const std::vector<std::size_t>& pixels, const ImageChannel& channel) {
  double sum = 0;
  for (const std::size_t pixel : pixels) sum += channel.values[pixel];
  return sum / static_cast<double>(pixels.size());
}

}  // namespace

std::vector<PatchReading> read_patches(const Scene& scene, const ChartInstance& chart, const Image& film,
                                       const std::vector<std::string>& channels) {
  if (film.width != scene.camera.width || film.height != scene.camera.height)
    throw Error(ErrorCode::input, chart.name,
                fmt::format("the film is none of this scene's camera (got {} x {}, needed {} x {})",
                            film.width, film.height, scene.camera.width, scene.camera.height));
  std::vector<PatchReading> readings;
  for (std::uint32_t i = chart.first; i < chart.first + chart.patches; ++i) {
    const ShapeInstance& shape = scene.shapes.at(i);
    const std::optional<Outline> outline = project(scene.camera, std::get<Quad>(shape.shape));
    if (!outline) throw Error(ErrorCode::input, shape.name, "its middle is beyond the film");
    const std::vector<std::size_t> pixels = pixels_in(*outline, film);
    if (pixels.empty())
      throw Error(ErrorCode::input, shape.name, "its middle holds no whole pixel: the film is too coarse");
    const auto& diffuse = std::get<DiffuseMaterial>(scene.materials[shape.material].model);
    PatchReading reading{
        shape.name.substr(chart.name.size() + 1), pixels.size(), {}, &diffuse.reflectance.curve()};
    for (const std::string& name : channels)
      reading.mean.push_back(mean_over(pixels, channel_of(film, name)));
    readings.push_back(std::move(reading));
  }
  return readings;
}

}  // namespace abbe
