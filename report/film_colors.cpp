#include "report/film_colors.h"

#include <algorithm>

#include "io/text.h"
#include "sensor/film/film_planes.h"
#include "sensor/film/recorded_attributes.h"
#include "sensor/response/polarised_channels.h"
#include "spectral/rgb.h"

namespace abbe {
namespace {

// Colours of a film with sensor channels: the matrix that it records, in the order of the sensor's channels.
FilmColors colors_by_matrix(const Image& image, const std::vector<std::string>& wanted) {
  const auto white = recorded_white(image);
  const auto matrix = image.metadata.find("to_xyz_d65");
  const bool mosaic = image.metadata.contains("mosaic");
  const auto names = image.metadata.find(mosaic ? "mosaic_channels" : "sensor_channels");
  if (matrix == image.metadata.end() || names == image.metadata.end()) return {wanted, {}, false, white};
  const std::vector<std::string> channels = intensities(split(names->second, ','));
  if (!std::is_permutation(channels.begin(), channels.end(), wanted.begin(), wanted.end()))
    return {wanted, {}, false, white};
  return {channels, parse_matrix3(matrix->second), true, white};
}

}  // namespace

FilmColors film_colors(const Image& image) {
  const std::vector<std::string> observer{"X", "Y", "Z"};
  const std::vector<std::string> rgb{"R", "G", "B"};
  const auto white = recorded_white(image);
  if (std::all_of(observer.begin(), observer.end(),
                  [&](const std::string& name) { return image.find(name) != nullptr; })) {
    if (!may_hold_tristimulus_values(image)) return colors_by_matrix(image, observer);
    return {observer, Matrix3(), false, white};
  }
  if (image.metadata.contains("channel.R")) return colors_by_matrix(image, rgb);
  const auto space = recorded_primaries(image);
  return {rgb, rgb_to_xyz(space.value_or(kRec709)), false,
          white || !space ? white : std::optional(space->white)};
}

}  // namespace abbe
