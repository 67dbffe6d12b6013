#include "transport/render/layers.h"

#include <algorithm>
#include <map>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "io/error.h"

namespace abbe {
namespace {

std::vector<std::string> layers_of_lights(const Scene& scene) {
  std::vector<std::string> names;
  for (const Light& light : scene.lights) names.push_back(layer_name(light.name));
  return names;
}

// Lights with one name have one layer. Two names that become equal as channel names are an error.
void require_distinct_layers(const Scene& scene, const std::vector<std::string>& layers) {
  std::map<std::string, std::string> names;
  for (const Light& light : scene.lights) {
    const auto& [layer, other] = *names.try_emplace(layer_name(light.name), light.name).first;
    if (other != light.name && std::find(layers.begin(), layers.end(), layer) != layers.end())
      throw Error(ErrorCode::usage, "--layers",
                  fmt::format("lights \"{}\" and \"{}\" would both give the layer {}{}: rename one of them",
                              other, light.name, kLightLayer, layer));
  }
}

std::vector<std::string> unique_names(std::vector<std::string> all,
                                      const std::optional<std::string>& more = {}) {
  if (more) all.push_back(*more);
  std::vector<std::string> once;
  for (const std::string& name : all)
    if (std::find(once.begin(), once.end(), name) == once.end()) once.push_back(name);
  return once;
}

}  // namespace

std::size_t Layers::layer_of(const ContributionInfo& light) const {
  if (!layer_of_light.empty()) return layer_of_light[light.light];
  return std::min(static_cast<std::size_t>(light.depth), names.size() - 1);
}

Layers bounce_layers(int last) {
  Layers layers;
  for (int events = 0; events < last; ++events) layers.names.push_back(fmt::format("bounce{}", events));
  layers.names.push_back(fmt::format("bounce{}plus", last));
  return layers;
}

std::string layer_name(std::string light) {
  const auto may_stay = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  };
  for (char& c : light)
    if (!may_stay(c)) c = '_';
  return light.empty() ? "_" : light;
}

Layers light_layers(const Scene& scene, const std::vector<std::string>& names) {
  const std::vector<std::string> available = layers_of_lights(scene);
  if (available.empty())
    throw Error(ErrorCode::usage, "--layers", "the scene has no light to make a layer of");
  for (const std::string& name : names)
    if (std::find(available.begin(), available.end(), layer_name(name)) == available.end())
      throw Error(ErrorCode::usage, "--layers",
                  fmt::format("no light has this name (got \"{}\", allowed {})", name,
                              fmt::join(unique_names(available), ", ")));
  std::vector<std::string> requested;
  for (const std::string& name : names) requested.push_back(layer_name(name));
  Layers layers{unique_names(names.empty() ? available : requested)};
  require_distinct_layers(scene, layers.names);
  const bool all = std::all_of(available.begin(), available.end(), [&](const std::string& name) {
    return std::find(layers.names.begin(), layers.names.end(), name) != layers.names.end();
  });
  if (!all && std::find(available.begin(), available.end(), kRestOfLights) != available.end())
    throw Error(
        ErrorCode::usage, "--layers",
        fmt::format("a light has the name \"{}\", which is that of the layer for all other lights: rename it",
                    kRestOfLights));
  if (!all) layers.names = unique_names(layers.names, kRestOfLights);
  for (const std::string& name : available) {
    auto found = std::find(layers.names.begin(), layers.names.end(), name);
    if (found == layers.names.end())
      found = std::find(layers.names.begin(), layers.names.end(), kRestOfLights);
    layers.layer_of_light.push_back(static_cast<std::uint32_t>(found - layers.names.begin()));
  }
  for (std::string& name : layers.names) name.insert(0, kLightLayer);
  return layers;
}

FilmShape layered(FilmShape film, std::size_t layers) {
  film.channels *= static_cast<int>(layers);
  return film;
}

}  // namespace abbe
