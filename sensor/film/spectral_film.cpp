#include "sensor/film/spectral_film.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "io/error.h"
#include "sensor/film/variance_name.h"
#include "spectral/sources.h"

namespace abbe {
namespace {

std::string bin_name(const SpectralBins& bins, int bin) {
  return fmt::format("{:.9g}nm", bins.center_nm(bin));
}

std::vector<float> divided(const std::vector<float>& values, std::span<const double> by, int power) {
  std::vector<float> quotients;
  quotients.reserve(values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    quotients.push_back(static_cast<float>(values[i] / (power == 1 ? by[i] : by[i] * by[i])));
  return quotients;
}

// The image's variance of each band, or nothing.
std::vector<const ImageChannel*> variances(const SpectralImage& image) {
  std::vector<const ImageChannel*> found;
  for (const SpectralBand& band : image.bands) {
    const std::string name = variance_of(spectral_channel(band.center_nm));
    for (const ImageChannel& channel : image.others)
      if (channel.name == name) found.push_back(&channel);
  }
  if (!found.empty() && found.size() != image.bands.size())
    throw Error(ErrorCode::input, "film", "has variances for some of its bands only");
  return found;
}

// Mean of a response over each band, its wavelengths alike.
std::vector<double> mean_weights(const Channel& channel, const std::vector<double>& edges) {
  std::vector<double> weights;
  for (std::size_t i = 0; i + 1 < edges.size(); ++i)
    weights.push_back(channel.weight.integral(edges[i], edges[i + 1]) / (edges[i + 1] - edges[i]));
  return weights;
}

}  // namespace

std::vector<Channel> spectral_channels(const SpectralBins& bins) {
  std::vector<Channel> channels;
  for (int bin = 0; bin < bins.count; ++bin)
    channels.push_back(energy_channel(bin_name(bins, bin), band(bins.from_nm + bin * bins.step_nm,
                                                                bins.from_nm + (bin + 1) * bins.step_nm)));
  return channels;
}

SpectralImage spectral_film(const Image& film, const SpectralBins& bins,
                            std::span<const double> exposure_per_radiance) {
  SpectralImage image{film.width, film.height, {}, {}, film.metadata};
  for (int bin = 0; bin < bins.count; ++bin) {
    const std::string name = bin_name(bins, bin);
    const ImageChannel* value = film.find(name);
    const ImageChannel* variance = film.find(variance_of(name));
    if (value == nullptr) throw Error(ErrorCode::internal, name, "the film lacks a bin of its sensor");
    image.bands.push_back({bins.center_nm(bin), divided(value->values, exposure_per_radiance, 1)});
    if (variance == nullptr) continue;
    image.others.push_back({variance_of(spectral_channel(bins.center_nm(bin))),
                            divided(variance->values, exposure_per_radiance, 2)});
  }
  return image;
}

Image expose(const SpectralImage& image, std::span<const Channel> channels,
             std::span<const double> exposure_per_radiance) {
  Image film{image.width, image.height, {}, {}};
  const std::vector<double> edges = band_edges(image.bands);
  const std::vector<const ImageChannel*> band_variances = variances(image);
  std::vector<ImageChannel> errors;
  for (const Channel& channel : channels) {
    if (channel.angular)
      throw Error(ErrorCode::usage, channel.name,
                  "responds by the angle of the light, which a spectral image does not tell");
    const std::vector<double> weights = mean_weights(channel, edges);
    std::vector<float> values;
    std::vector<float> bounds;
    for (std::size_t pixel = 0; pixel < film.pixels(); ++pixel) {
      double value = 0;
      double deviation = 0;
      for (std::size_t i = 0; i < weights.size(); ++i) {
        value += weights[i] * image.bands[i].radiance[pixel];
        if (!band_variances.empty())
          deviation += std::abs(weights[i]) * std::sqrt(band_variances[i]->values[pixel]);
      }
      values.push_back(static_cast<float>(value * exposure_per_radiance[pixel]));
      bounds.push_back(static_cast<float>(std::pow(deviation * exposure_per_radiance[pixel], 2)));
    }
    film.channels.push_back({channel.name, std::move(values)});
    errors.push_back({variance_of(channel.name), std::move(bounds)});
  }
  std::move(errors.begin(), errors.end(), std::back_inserter(film.channels));
  return film;
}

}  // namespace abbe
