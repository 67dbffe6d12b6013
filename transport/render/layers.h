#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "sensor/film/film.h"
#include "sensor/film/recorded_layers.h"
#include "transport/path/film_response.h"

namespace abbe {

/// How the light of a film is told apart: each path belongs to one layer, and the layers add up to the film.
struct Layers {
  std::vector<std::string> names;
  /// Of each light of the scene; where it is empty, the layer is the number of events between the light and
  /// the camera, or the last.
  std::vector<std::uint32_t> of_light = {};

  [[nodiscard]] std::size_t of(const LightHistory& light) const;
};

/// The terms of the Neumann series [Kajiya1986]: `bounce0`, light that is seen as it is emitted, `bounce1`,
/// light that was scattered once, and so on; what has had `last` events or more is in one layer,
/// `bounce<last>plus`.
[[nodiscard]] Layers bounce_layers(int last);
/// What the layer of all lights that have none of their own is called.
inline constexpr const char* kRestOfLights = "rest";
/// A layer `light.NAME` for each of some lights, by the names that `layer_name` makes of theirs, which
/// several lights may have, and `light.rest` for all others, if there are some. Of no names, all that the
/// scene's lights have. Throws Error{usage} for a name that none has, for a scene without lights, where two
/// names become that of one layer, and where one of them is called `rest` while there are others.
[[nodiscard]] Layers light_layers(const Scene& scene, const std::vector<std::string>& names);
/// The name of a light with _ for all but letters, digits, - and _, so that channels of files can have it.
[[nodiscard]] std::string layer_name(std::string light);

/// The shape of the sums of so many layers of a film.
[[nodiscard]] FilmShape layered(FilmShape film, std::size_t layers);

}  // namespace abbe
