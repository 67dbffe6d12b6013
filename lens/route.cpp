#include "lens/route.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lens/trace.h"

namespace abbe::lens {
namespace {

constexpr int kWavelengths = 9;

double reflectance(const SystemAt& at, std::size_t surface) {
  const SurfaceBetween<double> between{at.surface(surface), at.frames[surface], at.n[surface],
                                       at.n[surface + 1]};
  return surface_power(between, at.wavelength_nm, 1.0, true).R();
}

double semi_aperture(const SystemAt& at, std::size_t surface, double stop_radius_mm) {
  const double clear = at.surface(surface).semi_aperture_mm.value_or(std::numeric_limits<double>::infinity());
  return surface == at.system->stop ? std::min(clear, stop_radius_mm) : clear;
}

}  // namespace

Route direct_route(std::size_t surfaces) {
  Route route;
  for (std::size_t i = 0; i < surfaces; ++i) route.push_back({i, {}});
  return route;
}

Route route_of(const Ghost& ghost, std::size_t surfaces) {
  Route route = direct_route(ghost.first);
  route.push_back({ghost.first, {true, true}});
  for (std::size_t i = ghost.first - 1; i > ghost.second; --i) route.push_back({i, {false, false}});
  route.push_back({ghost.second, {false, true}});
  for (std::size_t i = ghost.second + 1; i < surfaces; ++i) route.push_back({i, {}});
  return route;
}

std::vector<Ghost> ghosts(const System& system, double low_nm, double high_nm) {
  const std::size_t count = system.surfaces.size();
  std::vector<std::vector<double>> reflectances;  // by wavelength and surface
  for (int k = 0; k < kWavelengths; ++k) {
    const SystemAt at(system, low_nm + (high_nm - low_nm) * k / (kWavelengths - 1));
    std::vector<double>& by_surface = reflectances.emplace_back();
    for (std::size_t i = 0; i < count; ++i) by_surface.push_back(reflectance(at, i));
  }
  std::vector<Ghost> all;
  for (std::size_t first = 1; first < count; ++first)
    for (std::size_t second = 0; second < first; ++second) {
      double both = 0;
      for (const std::vector<double>& by_surface : reflectances)
        both += by_surface[first] * by_surface[second] / kWavelengths;
      if (both > 0) all.push_back({first, second, both});
    }
  return all;
}

// A reflection is a refraction from n to -n if n and thicknesses are negated on the way back.
GhostFocus ghost_focus(const SystemAt& at, const Ghost& ghost, double stop_radius_mm) {
  const auto object = at.system->object_distance_mm;
  double y = 1;
  double nu = object ? 1 / *object : 0;
  double height = std::numeric_limits<double>::infinity();  // at the first vertex, in units of y there
  const Route route = route_of(ghost, at.size());
  for (std::size_t k = 0; k < route.size(); ++k) {
    const auto& [i, how] = route[k];
    const double before = how.forwards ? at.n[i] : -at.n[i + 1];
    const double across = how.forwards ? at.n[i + 1] : -at.n[i];
    const double behind = how.reflects ? -before : across;
    nu -= y * at.surface(i).profile.vertex_curvature() * (behind - before);
    const double u = nu / behind;
    const bool last = k + 1 == route.size();
    height = std::min(height, semi_aperture(at, i, stop_radius_mm) / std::abs(y));
    if (last) return {-y / u, 2 * height * std::abs(y + u * (at.vertex_z.back() - at.vertex_z[i]))};
    y += u * (at.vertex_z[route[k + 1].surface] - at.vertex_z[i]);
  }
  return {};
}

}  // namespace abbe::lens
