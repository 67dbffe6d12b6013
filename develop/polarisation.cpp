#include "develop/polarisation.h"

#include "develop/radiance.h"
#include "io/error.h"
#include "sensor/film/spectral_film.h"
#include "sensor/response/polarised_channels.h"
#include "spectral/matrix3.h"

namespace abbe {
namespace {

std::vector<StokesPlanes> required_planes(const Image& film) {
  std::vector<StokesPlanes> planes = stokes_planes(film);
  if (planes.empty())
    throw Error(
        ErrorCode::usage, "--stokes",
        "the film does not measure polarisation: set sensor/stokes in the scene, or use polarisers at three "
        "sufficiently different angles");
  return planes;
}

// Luminance of radiances, with its Stokes components.
Image luminances(const Image& film) {
  const SpectralImage image = spectral_image(film, "film");
  const std::vector<Channel> observer = observer_channels(Observer::cie1931);
  return expose(image, with_stokes({observer.at(1)}), std::vector<double>(film.pixels(), 1.0));
}

// Luminance per unit of each channel; 1 if colours are unknown.
std::vector<double> weights_of(const Image& film, std::size_t channels) {
  const auto recorded = film.metadata.find("to_xyz_d65");
  const auto matrix = recorded != film.metadata.end() ? parse_matrix3(recorded->second) : std::nullopt;
  std::vector<double> weights(channels, 1.0);
  if (matrix && channels == 3)
    for (int k = 0; k < 3; ++k) weights[static_cast<std::size_t>(k)] = (*matrix)[1][k];
  return weights;
}

}  // namespace

std::vector<PolarisationFigures> polarisation_of_light(const Image& film) {
  const std::vector<StokesPlanes> own = required_planes(film);
  const Image luminance = is_spectral(film) ? luminances(film) : Image{};
  const std::vector<StokesPlanes> planes = is_spectral(film) ? stokes_planes(luminance) : own;
  const std::vector<double> weights = weights_of(film, planes.size());
  std::vector<PolarisationFigures> all;
  all.reserve(film.pixels());
  for (std::size_t pixel = 0; pixel < film.pixels(); ++pixel) {
    StokesVector sum{};
    for (std::size_t k = 0; k < planes.size(); ++k)
      for (std::size_t i = 0; i < sum.size(); ++i) sum.at(i) += weights[k] * planes[k].at(pixel).at(i);
    all.push_back(polarisation_of(sum));
  }
  return all;
}

Image polarisation_image(const Image& film) {
  Image image{film.width, film.height, {}, film.metadata};
  erase_channel_attributes(image.metadata);
  erase_layout_attributes(image.metadata);
  erase_layer_and_feature_attributes(image.metadata);
  image.metadata.erase("sensor_channels");
  for (const StokesPlanes& planes : required_planes(film)) {
    ImageChannel degree{"DoP." + planes.channel, {}};
    ImageChannel linear{"DoLP." + planes.channel, {}};
    ImageChannel angle{"AoLP." + planes.channel, {}};
    for (std::size_t pixel = 0; pixel < film.pixels(); ++pixel) {
      const PolarisationFigures of = polarisation_of(planes.at(pixel));
      degree.values.push_back(static_cast<float>(of.degree));
      linear.values.push_back(static_cast<float>(of.linear_degree));
      angle.values.push_back(static_cast<float>(of.angle_deg));
    }
    if (planes.has_circular()) image.channels.push_back(std::move(degree));
    for (ImageChannel* channel : {&linear, &angle}) image.channels.push_back(std::move(*channel));
  }
  return image;
}

}  // namespace abbe
