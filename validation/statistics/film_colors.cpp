#include "validation/statistics/film_colors.h"

#include <algorithm>

#include "io/text.h"
#include "sensor/film/recorded_white.h"
#include "sensor/response/stokes_channels.h"
#include "spectral/rgb.h"

namespace abbe {

FilmColors film_colors(const Image& image) {
  const auto white = recorded_white(image);
  const std::vector<std::string> observer{"X", "Y", "Z"};
  if (std::all_of(observer.begin(), observer.end(),
                  [&](const std::string& name) { return image.find(name) != nullptr; }))
    return {observer, Matrix3(), false, white};
  const std::vector<std::string> rgb{"R", "G", "B"};
  if (!image.metadata.contains("channel.R")) {
    const auto space = recorded_primaries(image);
    return {rgb, rgb_to_xyz(space.value_or(kRec709)), false,
            white || !space ? white : std::optional(space->white)};
  }
  const auto matrix = image.metadata.find("to_xyz_d65");
  const bool mosaic = image.metadata.contains("mosaic");
  const auto names = image.metadata.find(mosaic ? "mosaic_channels" : "sensor_channels");
  if (matrix == image.metadata.end() || names == image.metadata.end()) return {rgb, {}, false, white};
  const std::vector<std::string> channels = intensities(split(names->second, ','));
  if (!std::is_permutation(channels.begin(), channels.end(), rgb.begin(), rgb.end()))
    return {rgb, {}, false, white};
  return {channels, parse_matrix3(matrix->second), true, white};
}

}  // namespace abbe
