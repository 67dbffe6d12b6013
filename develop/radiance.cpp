#include "develop/radiance.h"

#include <algorithm>
#include <array>
#include <memory>

#include <fmt/format.h>

#include "calibration/output/color_spaces.h"
#include "io/error.h"
#include "sensor/film/feature_film.h"
#include "sensor/film/film_planes.h"
#include "sensor/film/recorded_attributes.h"
#include "sensor/film/spectral_film.h"
#include "sensor/readout/demosaic.h"
#include "sensor/readout/speed.h"
#include "sensor/response/polarised_channels.h"
#include "spectral/rgb.h"

namespace abbe {
namespace {

constexpr std::array kRgb{"R", "G", "B"};

std::vector<std::string> names_of(const std::vector<Channel>& channels) {
  std::vector<std::string> names;
  for (const Channel& channel : channels) names.push_back(channel.name);
  return names;
}

bool has_variance(const SpectralImage& image) {
  return std::ranges::any_of(
      image.others, [](const ImageChannel& channel) { return channel.name.starts_with(variance_of("")); });
}

}  // namespace

void check_coverage(const SpectralImage& image, const Channel& channel, const std::filesystem::path& path,
                    Diagnostics& diagnostics) {
  constexpr double kNegligible = 1e-3;
  const std::vector<double> edges = band_edges(image.bands);
  const double missing = 1 - channel.weight.integral(edges.front(), edges.back()) / channel.weight.integral();
  if (!(missing > kNegligible)) return;
  const std::string text =
      fmt::format("covers only {} to {} nm, but {:.3g} % of the response of channel \"{}\" lies outside",
                  edges.front(), edges.back(), 100 * missing, channel.name);
  if (missing > 1 - kNegligible) throw Error(ErrorCode::input, path.string(), text);
  const auto source = std::make_shared<const SourceText>(SourceText{path.string(), ""});
  diagnostics.warning({source, SourcePosition::kWholeFile, ""}, text);
}

Image rec709_image(const Image& planes, const Matrix3& to_xyz) {
  const Matrix3 to_rgb = rgb_to_xyz(kRec709).inverse(true) * to_xyz;
  const std::size_t count = std::min<std::size_t>(planes.channels.size(), 3);
  Image rgb{planes.width, planes.height, {}, planes.metadata};
  for (int k = 0; k < 3; ++k) {
    ImageChannel& out = rgb.channels.emplace_back(ImageChannel{kRgb.at(static_cast<std::size_t>(k)), {}});
    out.values.reserve(planes.pixels());
    for (std::size_t i = 0; i < planes.pixels(); ++i) {
      double sum = 0;
      for (std::size_t j = 0; j < count; ++j)
        sum += to_rgb[k][static_cast<int>(j)] * planes.channels[j].values[i];
      out.values.push_back(static_cast<float>(sum));
    }
  }
  return rgb;
}

Image observed(const SpectralImage& image) {
  const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  const SpectralImage bands{image.width, image.height, image.bands, {}, {}};
  Image xyz = expose(bands, observer_channels(Observer::cie1931), std::vector<double>(pixels, 1.0));
  xyz.metadata = image.metadata;
  return rec709_image(xyz, Matrix3());
}

DisplayTransform display_of_radiance(const ViewOptions& view, std::optional<Chromaticity> white) {
  const Matrix3 adapted = white ? white_adaptation(*white) : Matrix3();
  return {{kRgb.begin(), kRgb.end()}, adapted * rgb_to_xyz_d65(kRec709), view};
}

FilmSensor observer_of(const Image& film, const std::filesystem::path& path, const ViewOptions& view,
                       std::optional<Chromaticity> white) {
  FilmSensor sensor;
  sensor.planes = sensor.channels = {kRgb.begin(), kRgb.end()};
  sensor.white = white ? white : recorded_white(film);
  sensor.display = display_of_radiance(view, sensor.white);
  sensor.display_exposure = recorded_display_exposure(film, path);
  return sensor;
}

ExposedFilm observed_film(const SpectralImage& image, const std::filesystem::path& path,
                          const ViewOptions& view, std::optional<Chromaticity> white) {
  return {observed(image), observer_of({0, 0, {}, image.metadata}, path, view, white)};
}

void erase_channel_attributes(std::map<std::string, std::string>& metadata) {
  std::erase_if(metadata, [](const auto& entry) { return entry.first.starts_with("channel."); });
}

void erase_sensor_attributes(std::map<std::string, std::string>& metadata) {
  erase_channel_attributes(metadata);
  std::erase_if(metadata, [](const auto& entry) {
    return entry.first.starts_with(kAnalyserKey) || entry.first.starts_with("exposure_s");
  });
  for (const char* key : {"sensor", "sensor_channels", "mosaic", "mosaic_channels", "gathering_area_m2",
                          "electrons_per_lx_s", "to_xyz_d65", kNoPictureKey, kDisplayExposureKey, kWhiteKey,
                          kWhiteFieldKey, kWhiteXyKey, kWhiteRequestedKey, kLightsXyKey, kHandednessKey})
    metadata.erase(key);
}

void erase_layer_and_feature_attributes(std::map<std::string, std::string>& metadata) {
  for (const char* key : {kLayersKey, kFeaturesKey, kShapeNamesKey}) metadata.erase(key);
}

void erase_layout_attributes(std::map<std::string, std::string>& metadata) {
  for (const char* key : {"spectralLayoutVersion", "emissiveUnits", "whiteLuminance", "expTime", "to_xyz_d65",
                          kHandednessKey, kSpectralBinsKey, kAxisKey, kDistanceKey, kOpeningKey, kShutterKey})
    metadata.erase(key);
}

Image exposed_film(const SpectralImage& image, const RadianceSensor& sensor,
                   const std::filesystem::path& path, Diagnostics& diagnostics) {
  for (const Channel& channel : sensor.channels) check_coverage(image, channel, path, diagnostics);
  Image film = expose(image, sensor.channels, sensor.exposure_per_radiance);
  if (sensor.mosaic) film = mosaicked(film, *sensor.mosaic, names_of(sensor.channels));
  film.metadata = image.metadata;
  erase_sensor_attributes(film.metadata);
  // The chromaticities of lights hold for all sensors but the 1964 observer.
  if (const auto lights = image.metadata.find(kLightsXyKey);
      lights != image.metadata.end() && standard_observer(intensities(sensor.channels)) != Observer::cie1964)
    film.metadata.insert(*lights);
  erase_layout_attributes(film.metadata);
  for (const char* key : {"aperture", kIsoSpeedKey}) film.metadata.erase(key);  // of the camera before
  if (has_variance(image))
    erase_error(film.metadata);
  else
    record_unknown_error(film.metadata);
  for (const auto& [key, value] : sensor.metadata) film.metadata[key] = value;
  return film;
}

}  // namespace abbe
