#include "sensor/film/recorded_mosaic.h"

#include <utility>

#include "io/text.h"

namespace abbe {

std::optional<RecordedMosaic> recorded_mosaic(const std::map<std::string, std::string>& attributes) {
  const auto pattern = attributes.find("mosaic");
  const auto names = attributes.find("mosaic_channels");
  if (pattern == attributes.end() || names == attributes.end()) return std::nullopt;
  std::vector<std::string> channels = split(names->second, ',');
  auto mosaic = parse_mosaic(pattern->second, channels);
  if (!mosaic) return std::nullopt;
  return RecordedMosaic{*std::move(mosaic), std::move(channels)};
}

}  // namespace abbe
