#include "sensor/film/film_planes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "io/error.h"
#include "io/spectral_exr.h"
#include "io/text.h"
#include "sensor/response/polarised_channels.h"

namespace abbe {
namespace {

// Name of a component. In spectral files, the names of intensities have the prefix of their component too.
std::string component_of(const std::string& intensity, int component) {
  if (intensity.starts_with("S0.")) return stokes_plane_name(component, intensity.substr(3));
  return stokes_plane_name(component, intensity);
}

}  // namespace

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

StokesVector StokesPlanes::at(std::size_t pixel) const {
  StokesVector stokes{};
  for (std::size_t i = 0; i < stokes.size(); ++i)
    if (const ImageChannel* plane = component.at(i)) stokes.at(i) = static_cast<double>(plane->values[pixel]);
  return stokes;
}

std::vector<StokesPlanes> stokes_planes(const Image& film) {
  const std::vector<std::string> planes = plane_names(film);
  const std::vector<std::string> intensity_names = intensities(planes);
  std::vector<StokesPlanes> all;
  if (intensity_names.empty() || intensity_names.size() == planes.size()) return all;
  const bool circular = film.find(component_of(intensity_names.front(), 3)) != nullptr;
  for (const std::string& channel : intensity_names) {
    StokesPlanes& planes_of_channel = all.emplace_back(StokesPlanes{channel, {film.find(channel)}});
    for (int component = 1; component < 4; ++component)
      planes_of_channel.component.at(static_cast<std::size_t>(component)) =
          film.find(component_of(channel, component));
    if (planes_of_channel.component[1] == nullptr || planes_of_channel.component[2] == nullptr ||
        planes_of_channel.has_circular() != circular)
      throw Error(ErrorCode::input, "film",
                  fmt::format("lacks a component of the Stokes vector of channel \"{}\"", channel));
  }
  return all;
}

PolarisationFigures polarisation_of(const StokesVector& stokes) {
  const auto [i, q, u, v] = stokes;
  const double linear = std::hypot(q, u);
  const double half = std::atan2(u, q) * 90 / std::numbers::pi;
  double angle_deg = half < 0 ? half + 180 : half;
  if (static_cast<float>(angle_deg) >= 180)
    angle_deg = 0;  // from below 0 by less than the resolution of a float
  if (!(i > 0)) return {0, 0, angle_deg};
  return {std::hypot(linear, v) / i, linear / i, angle_deg};
}

}  // namespace abbe
