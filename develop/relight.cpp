#include "develop/relight.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "io/error.h"
#include "io/text.h"
#include "sensor/film/recorded_layers.h"
#include "sensor/film/variance_name.h"

namespace abbe {
namespace {

// The lights that a film has layers of.
std::vector<std::string> lights_of(const Image& film) {
  std::vector<std::string> lights;
  const auto told = film.metadata.find(kLayersKey);
  if (told != film.metadata.end())
    for (const std::string& layer : parse_layers(told->second))
      if (layer.starts_with(kLightLayer))
        lights.push_back(layer.substr(std::string_view(kLightLayer).size()));
  if (lights.empty())
    throw Error(ErrorCode::usage, "--light",
                "the film has no layers of lights: render --layers lights makes them");
  return lights;
}

std::string layer_of(const std::string& light, const std::string& plane) {
  return kLightLayer + light + "." + plane;
}

// The planes that layers have of their own, in the order of the film.
std::vector<std::string> planes_of(const Image& film, const std::string& light) {
  std::vector<std::string> planes;
  for (const ImageChannel& channel : film.channels)
    if (film.find(layer_of(light, channel.name)) != nullptr) planes.push_back(channel.name);
  return planes;
}

// For each light, the factor of each plane.
std::vector<std::vector<double>> factors_by_light(const std::vector<std::string>& lights, std::size_t planes,
                                                  std::span<const LightFactor> factors) {
  std::vector<std::vector<double>> all(lights.size(), std::vector<double>(planes, 1));
  for (const LightFactor& asked : factors) {
    const auto light = std::find(lights.begin(), lights.end(), asked.light);
    if (light == lights.end())
      throw Error(ErrorCode::usage, "--light",
                  fmt::format("the film has no layer of it (got \"{}\", allowed {})", asked.light,
                              fmt::join(lights, ", ")));
    if (asked.factors.size() != 1 && asked.factors.size() != planes)
      throw Error(ErrorCode::usage, "--light",
                  fmt::format("got {} factors of \"{}\", allowed 1, or {} for the planes of the film",
                              asked.factors.size(), asked.light, planes));
    std::vector<double>& of = all[static_cast<std::size_t>(light - lights.begin())];
    of = asked.factors.size() == 1 ? std::vector<double>(planes, asked.factors[0]) : asked.factors;
  }
  return all;
}

// The least bound of `relight`, which is found at one of the factors or at 0, between which it is linear.
double variance_bound(double film, std::span<const double> layers, std::span<const double> factors) {
  const auto bound = [&](double share) {
    double deviation = std::abs(share) * std::sqrt(film);
    for (std::size_t g = 0; g < layers.size(); ++g)
      deviation += std::abs(factors[g] - share) * std::sqrt(layers[g]);
    return deviation;
  };
  double least = bound(0);
  for (const double share : factors) least = std::min(least, bound(share));
  return least * least;
}

ImageChannel* find(Image& image, const std::string& name) {
  const auto found = std::find_if(image.channels.begin(), image.channels.end(),
                                  [&name](const ImageChannel& channel) { return channel.name == name; });
  return found == image.channels.end() ? nullptr : &*found;
}

// One plane, `factors` being those of its lights.
void relight_plane(Image& film, const std::string& plane, const std::vector<std::string>& lights,
                   const std::vector<double>& factors) {
  std::vector<const ImageChannel*> layers;
  std::vector<const ImageChannel*> variances;
  for (const std::string& light : lights) {
    layers.push_back(film.find(layer_of(light, plane)));
    variances.push_back(film.find(variance_of(layer_of(light, plane))));
  }
  const bool known = std::find(variances.begin(), variances.end(), nullptr) == variances.end();
  ImageChannel& values = *find(film, plane);
  ImageChannel* variance = find(film, variance_of(plane));
  std::vector<double> of_layers(lights.size());
  for (std::size_t pixel = 0; pixel < film.pixels(); ++pixel) {
    double sum = 0;
    for (std::size_t g = 0; g < lights.size(); ++g)
      sum += factors[g] * static_cast<double>(layers[g]->values[pixel]);
    values.values[pixel] = static_cast<float>(sum);
    if (variance == nullptr || !known) continue;
    for (std::size_t g = 0; g < lights.size(); ++g)
      of_layers[g] = static_cast<double>(variances[g]->values[pixel]);
    float& own = variance->values[pixel];
    own = static_cast<float>(variance_bound(static_cast<double>(own), of_layers, factors));
  }
}

void drop_layers(Image& film) {
  std::erase_if(film.channels, [](const ImageChannel& channel) {
    return channel.name.starts_with(kLightLayer) || channel.name.starts_with(variance_of(kLightLayer));
  });
  film.metadata.erase(kLayersKey);
  film.metadata.erase("frame_mean_error");
}

}  // namespace

void relight(Image& film, std::span<const LightFactor> factors) {
  const std::vector<std::string> lights = lights_of(film);
  const std::vector<std::string> planes = planes_of(film, lights.front());
  const std::vector<std::vector<double>> by_light = factors_by_light(lights, planes.size(), factors);
  for (std::size_t k = 0; k < planes.size(); ++k) {
    std::vector<double> of_plane;
    for (const std::vector<double>& of_light : by_light) of_plane.push_back(of_light[k]);
    relight_plane(film, planes[k], lights, of_plane);
  }
  drop_layers(film);
}

}  // namespace abbe
