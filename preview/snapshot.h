#pragma once

#include <cstdint>

#include "film/sensor_identity.h"
#include "io/image.h"
#include "scene/scene.h"
#include "sensor/film/crop.h"
#include "transport/render/part.h"

namespace abbe {

/// A film under way, after a whole number of passes.
struct Snapshot {
  std::uint64_t samples = 0;  ///< Per pixel.
  Crop crop = {};             ///< The pixels that are rendered.
  Image film = {};            ///< Its planes, without variance, and what they tell of their sensor.
};

/// Takes it of a film that no thread adds to, on so many threads, as renders stand still meanwhile.
[[nodiscard]] Snapshot take_snapshot(const Scene& scene, const FilmIdentity& identity,
                                     const RenderResult& result, int threads);

}  // namespace abbe
