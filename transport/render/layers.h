#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "sensor/film/film.h"
#include "sensor/film/film_planes.h"
#include "transport/path/film_response.h"

namespace abbe {

/// Layers of a film. Each path belongs to one layer, and the layers add up to the film.
struct Layers {
  std::vector<std::string> names;  ///< Names of the layers; at least one.
  /// Index into `names` for each light of the scene. If empty, the layer of a path is its number of
  /// scattering events, limited to the last layer.
  std::vector<std::uint32_t> layer_of_light = {};

  /// Index into `names` of the layer to which a contribution belongs.
  [[nodiscard]] std::size_t layer_of(const ContributionInfo& light) const;
};

/// Layers for the terms of the Neumann series [Kajiya1986]. `bounce0` holds directly visible emission,
/// `bounce1` light that was scattered once, and so on. Paths with `last` or more events belong to the last
/// layer, `bounce<last>plus`. `last` is not negative.
[[nodiscard]] Layers bounce_layers(int last);
/// Name of the layer for all lights without a layer of their own, without the prefix `light.`.
inline constexpr const char* kRestOfLights = "rest";
/// One layer `light.NAME` for each of `names`, and `light.rest` for all other lights if there are any. Names
/// are compared as `layer_name` writes them; several lights with one name have one layer. If `names` is
/// empty, all names of the lights are used. Throws Error{usage} if
/// - the scene has no light, or no light has one of the names;
/// - two different light names give the same layer name;
/// - a light is called `rest` although other lights are left for `light.rest`.
[[nodiscard]] Layers light_layers(const Scene& scene, const std::vector<std::string>& names);
/// The name of a light as part of a channel name: every character but ASCII letters, digits, - and _ becomes
/// _. An empty name becomes _.
[[nodiscard]] std::string layer_name(std::string light);

/// Shape of a film that holds the planes of `film` once for each of `layers` layers.
[[nodiscard]] FilmShape layered(FilmShape film, std::size_t layers);

}  // namespace abbe
