#include "scene/chart/readout.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <ImathBox.h>
#include <fmt/format.h>

#include "sensor/film/recorded_crop.h"
#include "sensor/film/recorded_mosaic.h"

namespace abbe {
namespace {

// Of a patch's edges; what is nearer to its rim may be blurred by the lens.
constexpr double kMiddle = 0.7;
constexpr float kMiddleNm = 550;  // at which a patch is looked for
constexpr int kLensPoints = 32;   // along a side of what lens points are picked by
constexpr Imath::V2f kLensCentre{0.5F, 0.5F};

// Where light from a point comes to the film through one of the lens's points.
std::optional<Imath::V2f> seen_through(const Camera& camera, const Imath::V3d& point,
                                       const Imath::V2f& lens) {
  const auto seen = sample_towards(camera, Imath::V3f(point), lens, SampledSpectrum(kMiddleNm), 0);
  return seen ? std::optional(seen->film) : std::nullopt;
}

// The mean of where light from a point comes to through all of the lens.
std::optional<Imath::V2d> mean_image(const Camera& camera, const Imath::V3d& point) {
  // Thrice as wide each way, so that what is beside the film counts, too.
  const Imath::V2d size(camera.width, camera.height);
  Camera wider = camera;
  wider.width *= 3;
  wider.height *= 3;
  Imath::V2d sum(0, 0);
  int passed = 0;
  for (int j = 0; j < kLensPoints; ++j)
    for (int i = 0; i < kLensPoints; ++i) {
      const auto film = seen_through(wider, point, Imath::V2f(Imath::V2d(i + 0.5, j + 0.5) / kLensPoints));
      if (!film) continue;
      sum += Imath::V2d(*film) - size;
      ++passed;
    }
  if (passed == 0) return std::nullopt;
  const Imath::V2d mean = sum / passed;
  return Imath::Box2d({0, 0}, size).intersects(mean) ? std::optional(mean) : std::nullopt;
}

// The image of a point: through the middle of the lens, or, of one that light through this does not come
// from, as off the axis of a fisheye whose pupil moves with the field, the mean. Nothing for what the camera
// does not see.
std::optional<Imath::V2d> image_of(const Camera& camera, const Imath::V3d& point) {
  if (const auto middle = seen_through(camera, point, kLensCentre)) return Imath::V2d(*middle);
  return mean_image(camera, point);
}

// The corners of a patch's middle on the film; nothing for what the camera does not see.
std::optional<PatchOutline> project(const Camera& camera, const std::string& name, const Quad& quad) {
  constexpr double kLow = (1 - kMiddle) / 2;
  constexpr double kHigh = 1 - kLow;
  constexpr std::array<std::array<double, 2>, 4> kCorners{
      {{kLow, kLow}, {kHigh, kLow}, {kHigh, kHigh}, {kLow, kHigh}}};
  PatchOutline outline{name, {}};
  for (std::size_t i = 0; i < kCorners.size(); ++i) {
    const Imath::V3d point = quad.corner + quad.edge_u * kCorners[i][0] + quad.edge_v * kCorners[i][1];
    const auto image = image_of(camera, point);
    if (!image) return std::nullopt;
    outline.corners[i] = *image;
  }
  return outline;
}

const ImageChannel& channel_of(const Image& film, const std::string& name) {
  if (const ImageChannel* channel = film.find(name)) return *channel;
  throw Error(ErrorCode::input, "", fmt::format("the film has no channel {}", name));
}

// The channels of a film, which under a mosaic are all in one plane.
MeasuredPlanes planes_of(const Image& film, const std::vector<std::string>& channels) {
  MeasuredPlanes planes{{}, channels, {}, {}, recorded_areas(film)};
  if (const auto told = recorded_mosaic(film.metadata); told && told->channels == channels) {
    planes.mosaic = told->pattern;
    planes.planes.push_back(&channel_of(film, kRawPlane));
    return planes;
  }
  for (const std::string& name : channels) planes.planes.push_back(&channel_of(film, name));
  return planes;
}

}  // namespace

std::vector<PatchOutline> chart_outlines(const Scene& scene, const ChartInstance& chart) {
  const Camera camera = without_ghosts(scene.camera);
  std::vector<PatchOutline> outlines;
  for (std::uint32_t i = chart.first; i < chart.first + chart.patches; ++i) {
    const ShapeInstance& shape = scene.shapes.at(i);
    auto outline = project(camera, shape.name, std::get<Quad>(shape.shape));
    if (!outline) throw Error(ErrorCode::input, shape.name, "its middle is beyond the film");
    outlines.push_back(*std::move(outline));
  }
  return outlines;
}

std::vector<PatchReading> read_patches(const Scene& scene, const ChartInstance& chart, const Image& film,
                                       const std::vector<std::string>& channels) {
  require_film_of(scene, chart, film);
  const MeasuredPlanes planes = planes_of(film, channels);
  std::vector<PatchReading> readings;
  for (const PatchValues& patch : measure_patches(film, planes, chart_outlines(scene, chart))) {
    const ShapeInstance& shape = scene.shapes.at(chart.first + readings.size());
    const auto& diffuse = std::get<DiffuseMaterial>(scene.materials[shape.material].model);
    PatchReading& reading = readings.emplace_back(
        PatchReading{shape.name.substr(chart.name.size() + 1), 0, {}, &diffuse.reflectance.curve()});
    for (const PatchChannel& channel : patch.channels) {
      reading.pixels = planes.mosaic ? reading.pixels + channel.pixels : channel.pixels;
      reading.mean.push_back(channel.mean);
    }
  }
  return readings;
}

void require_film_of(const Scene& scene, const ChartInstance& chart, const Image& film) {
  if (film.width == scene.camera.width && film.height == scene.camera.height) return;
  throw Error(ErrorCode::input, chart.name,
              fmt::format("the film is none of this scene's camera (got {} x {}, needed {} x {})", film.width,
                          film.height, scene.camera.width, scene.camera.height));
}

}  // namespace abbe
