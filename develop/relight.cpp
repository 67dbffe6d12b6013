#include "develop/relight.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "develop/radiance.h"
#include "io/error.h"
#include "io/spectral_exr.h"
#include "io/text.h"
#include "sensor/film/film_planes.h"
#include "sensor/film/recorded_attributes.h"
#include "sensor/response/polarised_channels.h"
#include "spectral/rgb.h"

namespace abbe {
namespace {

std::vector<std::string> lights_of(const Image& film) {
  std::vector<std::string> lights;
  for (const std::string& layer : split(attribute_of(film.metadata, kLayersKey).value_or(""), ','))
    if (layer.starts_with(kLightLayer)) lights.push_back(layer.substr(std::string_view(kLightLayer).size()));
  if (lights.empty())
    throw Error(ErrorCode::usage, "--light",
                "the film has no layers of lights: render it with --layers lights");
  return lights;
}

std::string layer_of(const std::string& light, const std::string& plane) {
  return kLightLayer + light + "." + plane;
}

// The planes that have a layer for every light, in the order of the sensor or of wavelength.
std::vector<std::string> planes_with_layers(const Image& film, const std::vector<std::string>& lights) {
  std::vector<std::string> planes = plane_names(film);
  std::erase_if(planes, [&](const std::string& plane) {
    return std::ranges::any_of(
        lights, [&](const std::string& light) { return film.find(layer_of(light, plane)) == nullptr; });
  });
  if (planes.empty())
    throw Error(ErrorCode::usage, "--light",
                "the film no longer has its layers of lights: use the rendered film");
  return planes;
}

std::vector<std::vector<double>> factors_by_light(const std::vector<std::string>& lights, std::size_t planes,
                                                  std::span<const LightFactor> factors) {
  std::vector<std::vector<double>> all(lights.size(), std::vector<double>(planes, 1));
  for (const LightFactor& requested : factors) {
    const auto light = std::ranges::find(lights, requested.light);
    if (light == lights.end())
      throw Error(ErrorCode::usage, "--light",
                  fmt::format("the film has no layer of this light (got \"{}\", allowed {})", requested.light,
                              fmt::join(lights, ", ")));
    if (std::ranges::count(factors, requested.light, &LightFactor::light) > 1)
      throw Error(ErrorCode::usage, "--light", fmt::format("{} is named twice", requested.light));
    if (requested.factors.size() != 1 && requested.factors.size() != planes)
      throw Error(
          ErrorCode::usage, "--light",
          fmt::format("got {} factors of \"{}\", allowed 1{}", requested.factors.size(), requested.light,
                      planes > 1 ? fmt::format(", or {} for the planes of the film", planes) : ""));
    std::vector<double>& of = all[static_cast<std::size_t>(light - lights.begin())];
    of =
        requested.factors.size() == 1 ? std::vector<double>(planes, requested.factors[0]) : requested.factors;
  }
  return all;
}

// Standard deviation of `times` a quantity whose variance may be infinite.
double deviation_of(double times, double variance) {
  return times == 0 ? 0 : std::abs(times) * std::sqrt(variance);
}

// The smallest bound of `relight`. The bound is piecewise linear, so its minimum is at one of the factors or
// at 0.
double variance_bound(double film, std::span<const double> layers, std::span<const double> factors) {
  const auto bound = [&](double weight) {
    double deviation = deviation_of(weight, film);
    for (std::size_t g = 0; g < layers.size(); ++g) deviation += deviation_of(factors[g] - weight, layers[g]);
    return deviation;
  };
  double smallest = bound(0);
  for (const double weight : factors) smallest = std::min(smallest, bound(weight));
  return smallest * smallest;
}

ImageChannel* find(Image& image, const std::string& name) {
  const auto found = std::ranges::find(image.channels, name, &ImageChannel::name);
  return found == image.channels.end() ? nullptr : &*found;
}

void relight_plane(Image& film, const std::string& plane, const std::vector<std::string>& lights,
                   const std::vector<double>& factors) {
  std::vector<const ImageChannel*> layers;
  std::vector<const ImageChannel*> variances;
  for (const std::string& light : lights) {
    layers.push_back(film.find(layer_of(light, plane)));
    variances.push_back(film.find(variance_of(layer_of(light, plane))));
  }
  const bool known = std::ranges::find(variances, nullptr) == variances.end();
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

// Removes the layers of lights, and the error that holds for the film before.
void drop_layers(Image& film) {
  std::erase_if(film.channels, [](const ImageChannel& channel) {
    return channel.name.starts_with(kLightLayer) || channel.name.starts_with(variance_of(kLightLayer));
  });
  film.metadata.erase(kLayersKey);
  erase_error(film.metadata);
}

// The preview of a spectral film also has layers. It is recomputed if each light has a single factor, else
// removed.
void relight_preview(Image& film, const std::vector<std::string>& planes,
                     const std::vector<std::string>& lights,
                     const std::vector<std::vector<double>>& by_light) {
  const bool dimmed = std::ranges::all_of(by_light, [](const std::vector<double>& factors) {
    return std::ranges::adjacent_find(factors, std::not_equal_to<>()) == factors.end();
  });
  std::vector<std::string> previews;
  for (const ImageChannel& channel : film.channels)
    if (film.find(layer_of(lights.front(), channel.name)) != nullptr &&
        std::ranges::find(planes, channel.name) == planes.end())
      previews.push_back(channel.name);
  std::vector<double> of_lights;
  for (const std::vector<double>& factors : by_light) of_lights.push_back(factors.front());
  for (const std::string& preview : previews) {
    if (dimmed)
      relight_plane(film, preview, lights, of_lights);
    else
      std::erase_if(film.channels, [&](const ImageChannel& channel) { return channel.name == preview; });
  }
}

std::string factors_text(std::span<const LightFactor> factors) {
  std::vector<std::string> texts;
  for (const LightFactor& factor : factors)
    texts.push_back(fmt::format("{}={}", factor.light, fmt::join(factor.factors, ",")));
  return fmt::format("{}", fmt::join(texts, " "));
}

double mean_of(const Image& film, const std::string& channel) {
  const std::vector<float>& values = film.find(channel)->values;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// The quantity of `LightContribution` for the means of a film's planes.
double counted(const Image& film, const std::vector<std::string>& planes, const std::vector<double>& means) {
  Image one{1, 1, {}, film.metadata};
  for (std::size_t k = 0; k < planes.size(); ++k)
    one.channels.push_back({planes[k], {static_cast<float>(means[k])}});
  const auto value = [](const Image& image, const std::string& channel) {
    return static_cast<double>(image.find(channel)->values.front());
  };
  if (is_spectral(film)) {
    const Image rgb = observed(spectral_image(std::move(one), "film"));
    return multiply(rgb_to_xyz(kRec709), {value(rgb, "R"), value(rgb, "G"), value(rgb, "B")})[1];
  }
  if (is_of_observer(film)) return value(one, "Y");
  double sum = 0;
  for (const std::string& plane : intensities(planes)) sum += value(one, plane);
  return sum;
}

}  // namespace

bool is_of_observer(const Image& film) {
  return intensities(plane_names(film)) == std::vector<std::string>{"X", "Y", "Z"} &&
         may_hold_tristimulus_values(film);
}

std::vector<LightContribution> light_contributions(const Image& film, std::span<const LightFactor> factors) {
  const std::vector<std::string> lights = lights_of(film);
  const std::vector<std::string> planes = planes_with_layers(film, lights);
  const std::vector<std::vector<double>> by_light = factors_by_light(lights, planes.size(), factors);
  std::vector<LightContribution> contributions;
  for (std::size_t g = 0; g < lights.size(); ++g) {
    std::vector<double> before;
    std::vector<double> after;
    for (std::size_t k = 0; k < planes.size(); ++k) {
      before.push_back(mean_of(film, layer_of(lights[g], planes[k])));
      after.push_back(by_light[g][k] * before.back());
    }
    contributions.push_back({lights[g], counted(film, planes, before), counted(film, planes, after)});
  }
  return contributions;
}

void relight(Image& film, std::span<const LightFactor> factors) {
  const std::vector<std::string> lights = lights_of(film);
  const std::vector<std::string> planes = planes_with_layers(film, lights);
  const std::vector<std::vector<double>> by_light = factors_by_light(lights, planes.size(), factors);
  for (std::size_t k = 0; k < planes.size(); ++k) {
    std::vector<double> of_plane;
    for (const std::vector<double>& of_light : by_light) of_plane.push_back(of_light[k]);
    relight_plane(film, planes[k], lights, of_plane);
  }
  relight_preview(film, planes, lights, by_light);
  drop_layers(film);
  film.metadata["relit"] = factors_text(factors);
}

}  // namespace abbe
