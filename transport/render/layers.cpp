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

// Lights may share one of these layers by having one name, not by what files make of two.
void refuse_names_that_become_one(const Scene& scene, const std::vector<std::string>& layers) {
  std::map<std::string, std::string> names;
  for (const Light& light : scene.lights) {
    const auto& [layer, other] = *names.try_emplace(layer_name(light.name), light.name).first;
    if (other != light.name && std::find(layers.begin(), layers.end(), layer) != layers.end())
      throw Error(ErrorCode::usage, "--layers",
                  fmt::format("lights \"{}\" and \"{}\" would both be {}{}: call one otherwise", other,
                              light.name, kLightLayer, layer));
  }
}

std::vector<std::string> each_once(std::vector<std::string> all,
                                   const std::optional<std::string>& more = {}) {
  if (more) all.push_back(*more);
  std::vector<std::string> once;
  for (const std::string& name : all)
    if (std::find(once.begin(), once.end(), name) == once.end()) once.push_back(name);
  return once;
}

}  // namespace

std::size_t Layers::of(const LightHistory& light) const {
  if (!of_light.empty()) return of_light[light.light];
  return std::min(static_cast<std::size_t>(light.events), names.size() - 1);
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
  const std::vector<std::string> there = layers_of_lights(scene);
  if (there.empty()) throw Error(ErrorCode::usage, "--layers", "the scene has no light to tell apart");
  for (const std::string& name : names)
    if (std::find(there.begin(), there.end(), layer_name(name)) == there.end())
      throw Error(ErrorCode::usage, "--layers",
                  fmt::format("no light has such a name (got \"{}\", allowed {})", name,
                              fmt::join(each_once(there), ", ")));
  std::vector<std::string> asked;
  for (const std::string& name : names) asked.push_back(layer_name(name));
  Layers layers{each_once(names.empty() ? there : asked)};
  refuse_names_that_become_one(scene, layers.names);
  const bool all = std::all_of(there.begin(), there.end(), [&](const std::string& name) {
    return std::find(layers.names.begin(), layers.names.end(), name) != layers.names.end();
  });
  if (!all && std::find(there.begin(), there.end(), kRestOfLights) != there.end())
    throw Error(ErrorCode::usage, "--layers",
                fmt::format("a light has the name \"{}\", that of all others together: call it otherwise",
                            kRestOfLights));
  if (!all) layers.names = each_once(layers.names, kRestOfLights);
  for (const std::string& name : there) {
    auto found = std::find(layers.names.begin(), layers.names.end(), name);
    if (found == layers.names.end())
      found = std::find(layers.names.begin(), layers.names.end(), kRestOfLights);
    layers.of_light.push_back(static_cast<std::uint32_t>(found - layers.names.begin()));
  }
  for (std::string& name : layers.names) name.insert(0, kLightLayer);
  return layers;
}

FilmShape layered(FilmShape film, std::size_t layers) {
  film.channels *= static_cast<int>(layers);
  return film;
}

}  // namespace abbe
