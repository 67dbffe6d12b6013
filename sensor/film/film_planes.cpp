#include "sensor/film/film_planes.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "io/spectral_exr.h"
#include "io/text.h"
#include "sensor/film/variance_name.h"

namespace abbe {

std::vector<std::string> plane_names(const Image& film) {
  std::vector<std::tuple<char, double, std::string>> bands;
  if (is_spectral(film))
    for (const ImageChannel& channel : film.channels)
      if (const auto band = parse_spectral_channel(channel.name, "film"); band && band->kind != 'T')
        bands.emplace_back(band->kind, band->center_nm, channel.name);
  std::sort(bands.begin(), bands.end());
  std::vector<std::string> names;
  for (auto& [component, center_nm, name] : bands) names.push_back(std::move(name));
  if (!names.empty()) return names;
  if (const auto listed = film.metadata.find("sensor_channels"); listed != film.metadata.end())
    return split(listed->second, ',');
  for (const ImageChannel& channel : film.channels)
    if (!channel.name.starts_with(variance_of(""))) names.push_back(channel.name);
  return names;
}

bool may_hold_tristimulus_values(const Image& film) {
  const auto unit = film.metadata.find("channel.X");
  return unit == film.metadata.end() || unit->second.starts_with("photometric");
}

}  // namespace abbe
