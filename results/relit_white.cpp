#include "results/relit_white.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "io/spectral_exr.h"
#include "results/white.h"
#include "sensor/film/recorded_attributes.h"
#include "spectral/colorimetry.h"
#include "transport/render/layers.h"

namespace abbe {
namespace {

// Relative noise of the pilot that determined the film's main light.
constexpr double kPilotNoise = 0.02;

// A layer of one or more lights, with their name and colour if all have the same one.
struct LightLayer {
  LightContribution contribution;
  std::string name;
  std::optional<Chromaticity> xy;
};

bool is_same(const std::optional<Chromaticity>& a, const std::optional<Chromaticity>& b) {
  constexpr double kRounding = 1e-9;
  return a && b && std::abs((*a)[0] - (*b)[0]) + std::abs((*a)[1] - (*b)[1]) < kRounding;
}

// The layer that contains a light: its own or that of all other lights; nullptr if there is neither.
LightLayer* layer_of(std::vector<LightLayer>& layers, const std::string& light) {
  for (const std::string& name : {layer_name(light), std::string(kRestOfLights)})
    for (LightLayer& layer : layers)
      if (layer.contribution.light == name) return &layer;
  return nullptr;
}

std::vector<LightLayer> layers_of(std::vector<LightContribution> contributions,
                                  const std::vector<RecordedLight>& lights) {
  std::vector<LightLayer> layers;
  for (LightContribution& contribution : contributions) layers.push_back({std::move(contribution), "", {}});
  for (const RecordedLight& light : lights) {
    LightLayer* layer = layer_of(layers, light.name);
    if (layer == nullptr) continue;
    if (layer->name.empty())
      *layer = {layer->contribution, light.name, light.xy};
    else if (!is_same(layer->xy, light.xy))
      *layer = {layer->contribution, layer->contribution.light, {}};
  }
  return layers;
}

// Contribution of a layer and of all layers of its colour.
double group_contribution(const std::vector<LightLayer>& layers, const LightLayer& layer,
                          double LightContribution::*when) {
  double sum = 0;
  for (const LightLayer& other : layers)
    if (&other == &layer || is_same(other.xy, layer.xy)) sum += other.contribution.*when;
  return sum;
}

// The layer whose colour contributes most; among layers of this colour, the one that contributes most.
const LightLayer& main_layer(const std::vector<LightLayer>& layers, double LightContribution::*when) {
  return *std::max_element(layers.begin(), layers.end(), [&](const LightLayer& a, const LightLayer& b) {
    return std::pair(group_contribution(layers, a, when), a.contribution.*when) <
           std::pair(group_contribution(layers, b, when), b.contribution.*when);
  });
}

bool is_main(const std::vector<LightLayer>& layers, const LightLayer& layer,
             double LightContribution::*when) {
  return group_contribution(layers, layer, when) >=
         (1 - kPilotNoise) * group_contribution(layers, main_layer(layers, when), when);
}

// The layer of the film's white, whose colour is set to the white. nullptr if the white is not that of a
// layer.
LightLayer* layer_of_white(std::vector<LightLayer>& layers, const std::vector<RecordedLight>& lights,
                           const Image& film) {
  const auto xy = recorded_white(film);
  if (!xy) return nullptr;
  const std::string& name = film.metadata.at(kWhiteKey);
  const auto light = std::find_if(lights.begin(), lights.end(),
                                  [&](const RecordedLight& recorded) { return recorded.name == name; });
  if (light != lights.end() ? light->xy && !is_same(light->xy, xy) : !lights.empty()) return nullptr;
  LightLayer* layer = layer_of(layers, name);
  if (layer != nullptr) layer->xy = xy;
  return layer;
}

}  // namespace

RelitWhite relit_white(const Image& film, std::span<const LightFactor> factors) {
  if (film.metadata.contains(kWhiteRequestedKey)) return {};
  const std::vector<RecordedLight> lights = recorded_lights(film);
  std::vector<LightLayer> layers = layers_of(light_contributions(film, factors), lights);
  const LightLayer* own = layer_of_white(layers, lights, film);
  if (own == nullptr || !is_main(layers, *own, &LightContribution::before) ||
      is_main(layers, *own, &LightContribution::after))
    return {};
  const std::string& white = film.metadata.at(kWhiteKey);
  const LightLayer& left = main_layer(layers, &LightContribution::after);
  if (!left.xy)
    return {
        {},
        fmt::format("the white remains that of \"{}\", which is no longer the main light: the film does not "
                    "record the colour of \"{}\" (choose a white with --white)",
                    white, left.contribution.light)};
  RelitWhite relit{White{left.name, "the remaining main light", *left.xy}, ""};
  if (!is_spectral(film) && !is_of_observer(film))
    relit.warning = fmt::format(
        "\"{}\", the remaining main light, is now white, but the sensor's colours are still corrected for "
        "\"{}\", the white of the render (--white {} restores that white)",
        left.name, white, white);
  return relit;
}

}  // namespace abbe
