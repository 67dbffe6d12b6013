#include "sensor/film/stokes_film.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "io/error.h"
#include "sensor/film/film_planes.h"
#include "sensor/response/stokes_channels.h"

namespace abbe {
namespace {

// Spectral files name intensities after their component too.
std::string component_of(const std::string& intensity, int component) {
  if (intensity.starts_with("S0.")) return name_of({component, intensity.substr(3)});
  return name_of({component, intensity});
}

}  // namespace

StokesVector StokesPlanes::at(std::size_t pixel) const {
  StokesVector stokes{};
  for (std::size_t i = 0; i < stokes.size(); ++i)
    if (const ImageChannel* plane = component.at(i)) stokes.at(i) = static_cast<double>(plane->values[pixel]);
  return stokes;
}

std::vector<StokesPlanes> stokes_planes(const Image& film) {
  const std::vector<std::string> planes = plane_names(film);
  const std::vector<std::string> counting = intensities(planes);
  std::vector<StokesPlanes> all;
  if (counting.empty() || counting.size() == planes.size()) return all;
  const bool circular = film.find(component_of(counting.front(), 3)) != nullptr;
  for (const std::string& channel : counting) {
    StokesPlanes& of = all.emplace_back(StokesPlanes{channel, {film.find(channel)}});
    for (int component = 1; component < 4; ++component)
      of.component.at(static_cast<std::size_t>(component)) = film.find(component_of(channel, component));
    if (of.component[1] == nullptr || of.component[2] == nullptr || of.tells_circular() != circular)
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
  if (static_cast<float>(angle_deg) >= 180) angle_deg = 0;  // from below 0 by less than a float tells
  if (!(i > 0)) return {0, 0, angle_deg};
  return {std::hypot(linear, v) / i, linear / i, angle_deg};
}

}  // namespace abbe
