#include "results/spectral.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "develop/radiance.h"
#include "io/error.h"
#include "io/text.h"
#include "results/rendered_film.h"
#include "scene/camera/camera.h"
#include "sensor/film/recorded_attributes.h"
#include "sensor/film/spectral_film.h"

namespace abbe {
namespace {

// Unit of a bin as recorded in the film, in addition to the layout's `emissiveUnits`.
constexpr const char* kRadiance = "radiance, W per m^2 and sr of the band";

// Irradiance at the centre of the film per unit of radiance [sr].
double axis_weight(const Camera& camera) {
  const Imath::V2f center(static_cast<float>(camera.width) / 2, static_cast<float>(camera.height) / 2);
  return mean_weight(camera, opening_tangent(camera), center);
}

// Distance from lens to film [pixels], which determines the falloff towards the corners; empty for a probe.
std::optional<double> image_distance(const Camera& camera) {
  const std::optional<double> distance = traits(camera).image_distance;
  return distance ? std::optional(*distance / camera.pixel_pitch) : std::nullopt;
}

double opening_of(const Image& film) {
  return number_of(film.metadata, kOpeningKey).value_or(0);
}

// A camera that weights radiance like the one that made the film, given that one's opening.
Camera camera_of(const Image& film) {
  const double central = number_of(film.metadata, kAxisKey).value() * (1 + std::pow(opening_of(film), 2));
  Camera camera{IrradianceProbe{}, film.width, film.height, 1};
  if (const auto distance = number_of(film.metadata, kDistanceKey)) {
    Pinhole lens;
    lens.image_distance = *distance;
    lens.aperture_radius = lens.image_distance * std::sqrt(central / std::numbers::pi);
    camera.kind = lens;
  }
  return camera;
}

std::vector<double> exposure_per_radiance(const Camera& camera, double opening, double exposure_s) {
  std::vector<double> factors;
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const Imath::V2f center(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
      factors.push_back(exposure_s * mean_weight(camera, opening, center));
    }
  return factors;
}

SpectralBins bins_of(const Image& film) {
  const std::vector<std::string> words = split(film.metadata.at(kSpectralBinsKey), ' ');
  return {parse_number(words.at(0)).value(), parse_number(words.at(1)).value(),
          static_cast<int>(parse_number(words.at(2)).value())};
}

// Exposure time [s] times the mean transmission of the shutter.
double exposure_of(const Image& film) {
  return number_of(film.metadata, "exposure_s").value() * number_of(film.metadata, kShutterKey).value_or(1);
}

// Files of Abbe record the camera; files of other programs do not.
void require_same_view(const SpectralImage& image, const Camera& camera, const std::filesystem::path& path) {
  if (!image.metadata.contains(kAxisKey)) return;
  const std::optional<std::string> theirs = attribute_of(image.metadata, kDistanceKey);
  const bool lens = theirs.has_value();
  const std::optional<double> ours = image_distance(camera);
  if (lens != ours.has_value())
    throw Error(ErrorCode::input, path.string(),
                fmt::format("was rendered with another kind of camera (got {}, allowed {})",
                            lens ? "a lens" : "a meter", lens ? "a meter" : "a lens"));
  if (lens && std::abs(parse_number(*theirs).value_or(0) / *ours - 1) > 1e-6)
    throw Error(
        ErrorCode::input, path.string(),
        fmt::format(
            "was rendered with another field of view (got an image distance of {} pixels, allowed {})",
            *theirs, *ours));
}

}  // namespace

void add_spectral_identity(const Scene& scene, FilmIdentity& identity) {
  identity[kSpectralBinsKey] =
      fmt::format("{} {} {}", scene.spectral->from_nm, scene.spectral->step_nm, scene.spectral->count);
  identity[kAxisKey] = fmt::format("{}", axis_weight(scene.camera));
  if (const auto distance = image_distance(scene.camera))
    identity[kDistanceKey] = fmt::format("{}", *distance);
  if (const double opening = opening_tangent(scene.camera); opening > 0)
    identity[kOpeningKey] = fmt::format("{}", opening);
  if (scene.shutter.mean() != 1) identity[kShutterKey] = fmt::format("{}", scene.shutter.mean());
  identity["whiteLuminance"] = "1";  // luminance [cd/m^2] of 1 in all channels of the preview
}

std::vector<double> exposure_per_radiance(const Scene& scene) {
  return exposure_per_radiance(scene.camera, opening_tangent(scene.camera),
                               scene.exposure_s * scene.shutter.mean());
}

Image spectral_film_image(const Image& film) {
  SpectralImage image = spectral_film(
      film, bins_of(film), exposure_per_radiance(camera_of(film), opening_of(film), exposure_of(film)));
  for (ImageChannel& channel : observed(image).channels) image.others.push_back(std::move(channel));
  erase_channel_attributes(image.metadata);
  for (int component = 0; component < (image.is_polarised() ? 4 : 1); ++component)
    for (const SpectralBand& band : image.bands)
      image.metadata["channel." + spectral_channel(band.center_nm, component)] = kRadiance;
  return spectral_layout(image);
}

Image expose_radiances(const Scene& scene, const SpectralImage& image, const std::filesystem::path& path,
                       Diagnostics& diagnostics) {
  const Camera& camera = scene.camera;
  if (scene.spectral)
    throw Error(ErrorCode::usage, "--scene",
                "its sensor is spectral itself (allowed: a sensor with channels)");
  if (camera.width != image.width || camera.height != image.height)
    throw Error(ErrorCode::input, path.string(),
                fmt::format("has another size than the sensor (got {} x {}, allowed {} x {})", image.width,
                            image.height, camera.width, camera.height));
  require_same_view(image, camera, path);
  return exposed_film(image,
                      {scene.channels, scene.mosaic, exposure_per_radiance(scene), film_attributes(scene)},
                      path, diagnostics);
}

}  // namespace abbe
