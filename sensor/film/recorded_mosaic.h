#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sensor/response/mosaic.h"

namespace abbe {

/// A mosaic, and the names of its channels, to which `Mosaic::channel` refers.
struct RecordedMosaic {
  Mosaic pattern;
  std::vector<std::string> channels;
};

/// Mosaic that the attributes `mosaic` and `mosaic_channels` of a film or of a file developed from it record.
/// Nothing if they record none or are malformed.
[[nodiscard]] std::optional<RecordedMosaic> recorded_mosaic(
    const std::map<std::string, std::string>& attributes);

}  // namespace abbe
