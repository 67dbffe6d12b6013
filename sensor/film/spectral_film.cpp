#include "sensor/film/spectral_film.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "io/error.h"
#include "sensor/film/film_planes.h"
#include "sensor/response/polarised_channels.h"
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

// Bands of a Stokes component of an image.
auto& bands_of(auto& image, int component) {
  return component == 0 ? image.bands : image.polarised.at(static_cast<std::size_t>(component) - 1);
}

// Adds the bins of a Stokes component of a film to the image as radiances.
void add_component(const Image& film, const SpectralBins& bins, int component,
                   std::span<const double> exposure_per_radiance, SpectralImage& image) {
  for (int bin = 0; bin < bins.count; ++bin) {
    const std::string name = stokes_plane_name(component, bin_name(bins, bin));
    const ImageChannel* value = film.find(name);
    const ImageChannel* variance = film.find(variance_of(name));
    if (value == nullptr) throw Error(ErrorCode::internal, name, "the film lacks a bin of its sensor");
    bands_of(image, component)
        .push_back({bins.center_nm(bin), divided(value->values, exposure_per_radiance, 1)});
    if (variance == nullptr) continue;
    image.others.push_back({variance_of(spectral_channel(bins.center_nm(bin), component)),
                            divided(variance->values, exposure_per_radiance, 2)});
  }
}

// Variance channel of each band of a component; empty if the image has none.
std::vector<const ImageChannel*> variances(const SpectralImage& image, int component) {
  std::vector<const ImageChannel*> matches;
  for (const SpectralBand& band : image.bands) {
    const std::string name = variance_of(spectral_channel(band.center_nm, component));
    for (const ImageChannel& channel : image.others)
      if (channel.name == name) matches.push_back(&channel);
  }
  if (!matches.empty() && matches.size() != image.bands.size())
    throw Error(ErrorCode::input, "film", "has variances for only some of its bands");
  return matches;
}

// Mean of a response over each band.
std::vector<double> mean_weights(const Curve& response, const std::vector<double>& edges) {
  std::vector<double> weights;
  for (std::size_t i = 0; i + 1 < edges.size(); ++i)
    weights.push_back(response.integral(edges[i], edges[i + 1]) / (edges[i + 1] - edges[i]));
  return weights;
}

// Contribution of one band of a Stokes component to a channel.
struct Term {
  double weight;
  const std::vector<float>& radiance;
  const ImageChannel* variance;
};

void add_terms(const SpectralImage& image, int component, const Curve& response, std::vector<Term>& terms) {
  const std::vector<double> weights = mean_weights(response, band_edges(image.bands));
  const std::vector<const ImageChannel*> errors = variances(image, component);
  const std::vector<SpectralBand>& bands = bands_of(image, component);
  for (std::size_t i = 0; i < weights.size(); ++i)
    terms.push_back({weights[i], bands[i].radiance, errors.empty() ? nullptr : errors[i]});
}

std::vector<Term> terms_of(const SpectralImage& image, const Channel& channel) {
  std::vector<Term> terms;
  if (!channel.analyser || channel.analyser->i != 0) add_terms(image, 0, channel.weight, terms);
  if (!channel.analyser) return terms;
  if (!image.is_polarised())
    throw Error(ErrorCode::usage, channel.name,
                "depends on polarisation, which a spectral image without S1, S2 and S3 does not record");
  const Analyser& row = *channel.analyser;
  const std::array rows{row.q, row.u, row.v};
  for (int component = 1; component < 4; ++component)
    if (const float factor = rows.at(static_cast<std::size_t>(component) - 1); factor != 0)
      add_terms(image, component, product(channel.weight, scaled(row.contrast, static_cast<double>(factor))),
                terms);
  return terms;
}

}  // namespace

std::vector<double> edges_nm(const SpectralBins& bins) {
  std::vector<double> edges;
  for (int bin = 0; bin <= bins.count; ++bin) edges.push_back(bins.from_nm + bin * bins.step_nm);
  return edges;
}

std::vector<Channel> spectral_channels(const SpectralBins& bins) {
  const std::vector<double> edges = edges_nm(bins);
  std::vector<Channel> channels;
  for (std::size_t bin = 0; bin + 1 < edges.size(); ++bin)
    channels.push_back(
        energy_channel(bin_name(bins, static_cast<int>(bin)), band(edges[bin], edges[bin + 1])));
  return channels;
}

SpectralImage spectral_film(const Image& film, const SpectralBins& bins,
                            std::span<const double> exposure_per_radiance) {
  SpectralImage image{film.width, film.height, {}, {}, film.metadata};
  const bool polarised = film.find(stokes_plane_name(1, bin_name(bins, 0))) != nullptr;
  for (int component = 0; component < (polarised ? 4 : 1); ++component)
    add_component(film, bins, component, exposure_per_radiance, image);
  return image;
}

Image expose(const SpectralImage& image, std::span<const Channel> channels,
             std::span<const double> exposure_per_radiance) {
  Image film{image.width, image.height, {}, {}};
  std::vector<ImageChannel> errors;
  for (const Channel& channel : channels) {
    if (channel.angular)
      throw Error(ErrorCode::usage, channel.name,
                  "depends on the angle of incidence, which a spectral image does not record");
    const std::vector<Term> terms = terms_of(image, channel);
    std::vector<float> values;
    std::vector<float> bounds;
    for (std::size_t pixel = 0; pixel < film.pixels(); ++pixel) {
      double value = 0;
      double deviation = 0;
      for (const Term& term : terms) {
        value += term.weight * term.radiance[pixel];
        if (term.variance != nullptr && term.weight != 0)  // otherwise it may be infinite
          deviation += std::abs(term.weight) * std::sqrt(term.variance->values[pixel]);
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
