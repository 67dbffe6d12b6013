#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sensor/response/mosaic.h"

namespace abbe {

/// A mosaic with the names of its channels, in their order.
struct RecordedMosaic {
  Mosaic pattern;
  std::vector<std::string> channels;
};

/// The mosaic that the attributes of a film, or of what was developed of it, tell; nothing where they tell of
/// none or make no sense.
[[nodiscard]] std::optional<RecordedMosaic> recorded_mosaic(
    const std::map<std::string, std::string>& attributes);

}  // namespace abbe
