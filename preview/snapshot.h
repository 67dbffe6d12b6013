#pragma once

#include <cstdint>

#include "io/image.h"
#include "results/film_attributes.h"
#include "scene/scene.h"
#include "sensor/film/crop.h"
#include "transport/render/part.h"

namespace abbe {

/// A film in progress, after a whole number of passes.
struct Snapshot {
  std::uint64_t samples = 0;  ///< Samples per pixel.
  Crop crop = {};             ///< Rendered pixels.
  /// Means of `Scene::film_planes`, without variance, and the attributes of the film. It has the full size;
  /// pixels outside the crop are 0.
  Image film = {};
};

/// Copies the film's means on `threads` threads, because the render waits meanwhile. `identity` become the
/// attributes of the image. No thread may add to the film.
[[nodiscard]] Snapshot take_snapshot(const Scene& scene, const FilmIdentity& identity,
                                     const RenderResult& result, int threads);

}  // namespace abbe
