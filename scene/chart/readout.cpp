#include "scene/chart/readout.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <ImathBox.h>
#include <fmt/format.h>

#include "sensor/film/crop.h"
#include "sensor/film/recorded_attributes.h"

namespace abbe {
namespace {

// Inner fraction of a patch's edges; the lens may blur what is nearer to the rim.
constexpr double kInnerFraction = 0.7;
constexpr float kPatchNm = 550;  // wavelength at which patches are located
constexpr int kLensPoints = 32;  // lens points along each side of the sampling grid
constexpr Imath::V2f kLensCenter{0.5F, 0.5F};

// Film position of a point's light through one point of the lens.
std::optional<Imath::V2f> image_through(const Camera& camera, const Imath::V3d& point,
                                        const Imath::V2f& lens) {
  const auto connection = sample_towards(camera, Imath::V3f(point), lens, SampledSpectrum(kPatchNm), 0);
  return connection ? std::optional(connection->film) : std::nullopt;
}

// Mean film position of a point's light over the whole lens.
std::optional<Imath::V2d> mean_image(const Camera& camera, const Imath::V3d& point) {
  // Three times as wide and high, so that light outside the film counts too.
  const Imath::V2d size(camera.width, camera.height);
  Camera wider = camera;
  wider.width *= 3;
  wider.height *= 3;
  Imath::V2d sum(0, 0);
  int passed = 0;
  for (int j = 0; j < kLensPoints; ++j)
    for (int i = 0; i < kLensPoints; ++i) {
      const auto film = image_through(wider, point, Imath::V2f(Imath::V2d(i + 0.5, j + 0.5) / kLensPoints));
      if (!film) continue;
      sum += Imath::V2d(*film) - size;
      ++passed;
    }
  if (passed == 0) return std::nullopt;
  const Imath::V2d mean = sum / passed;
  return Imath::Box2d({0, 0}, size).intersects(mean) ? std::optional(mean) : std::nullopt;
}

// Image of a point: by the ray through the center of the lens, otherwise the mean over the lens. The latter
// applies off the axis of a fisheye, whose pupil moves with the field. Nothing if the camera does not see the
// point.
std::optional<Imath::V2d> image_of(const Camera& camera, const Imath::V3d& point) {
  if (const auto image = image_through(camera, point, kLensCenter)) return Imath::V2d(*image);
  return mean_image(camera, point);
}

// The corners on the film of a patch's inner part; nothing if the camera does not see them.
std::optional<PatchOutline> project(const Camera& camera, const std::string& name, const FlatFace& patch) {
  constexpr double kLow = (1 - kInnerFraction) / 2;
  constexpr double kHigh = 1 - kLow;
  constexpr std::array<std::array<double, 2>, 4> kCorners{
      {{kLow, kLow}, {kHigh, kLow}, {kHigh, kHigh}, {kLow, kHigh}}};
  PatchOutline outline{name, {}};
  for (std::size_t i = 0; i < kCorners.size(); ++i) {
    const Imath::V3d point = patch.corner + patch.edge_u * kCorners[i][0] + patch.edge_v * kCorners[i][1];
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

// The channels of a film; under a mosaic they share one plane.
MeasuredPlanes planes_of(const Image& film, const std::vector<std::string>& channels) {
  MeasuredPlanes planes{{}, channels, {}, {}, recorded_areas(film)};
  if (const auto mosaic = recorded_mosaic(film.metadata); mosaic && mosaic->channels == channels) {
    planes.mosaic = mosaic->pattern;
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
    auto outline = project(camera, shape.name, *flat_face(shape.shape));
    if (!outline) throw Error(ErrorCode::input, shape.name, "its inner part is outside the film");
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
  throw Error(
      ErrorCode::input, chart.name,
      fmt::format("the film does not have the size of this scene's camera (got {} x {}, expected {} x {})",
                  film.width, film.height, scene.camera.width, scene.camera.height));
}

}  // namespace abbe
