#pragma once

#include <optional>

#include "io/image.h"
#include "sensor/film/crop.h"

namespace abbe {

/// The pixels that a film, or what was developed of it, tells to have; nothing where it has all.
[[nodiscard]] std::optional<Crop> recorded_crop(const Image& film);

}  // namespace abbe
