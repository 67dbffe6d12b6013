#include "scene/camera/lens_optics.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "lens/exit_pupil.h"
#include "lens/paraxial.h"

namespace abbe {
namespace {

using Imath::V2d;

V2d half_size_mm(const FilmGrid& grid) {
  return V2d(grid.width, grid.height) * (grid.pixel_pitch * lens::kMmPerM / 2);
}

// Cosine from the far corner of the film to the edge of the last surface, for any displacement of that
// surface.
double steepest_cosine(const lens::SpectralSystem& system, const V2d& half_film_mm) {
  const lens::Surface& last = system.system().surfaces.back();
  const double rim = *last.semi_aperture_mm;
  const double tilt = (std::abs(last.tilt_deg.x) + std::abs(last.tilt_deg.y)) * std::numbers::pi / 180;
  const double edge = std::max(0.0, last.profile.sag(rim * rim)) + rim * std::sin(tilt);
  const double depth = std::max(0.0, system.image_z() - system.last_z() - edge);
  const double across = half_film_mm.length() + rim + last.decenter_mm.length();
  return depth / std::hypot(depth, across);
}

std::optional<double> finite(double mm) {
  return std::isfinite(mm) ? std::optional(mm) : std::nullopt;
}

// The image of a near object is as large as that of a pinhole at the first vertex.
std::optional<double> pinhole_distance(const lens::SystemAt& at) {
  const lens::FirstOrder first = lens::first_order(at);
  const auto& object_mm = at.system->object_distance_mm;
  return finite(std::abs(object_mm ? first.magnification * *object_mm : first.focal_length_mm));
}

}  // namespace

LensOptics::LensOptics(lens::System lens, double stop_radius_mm, const FilmGrid& grid, double low_nm,
                       double high_nm, Ghosts ghosts)
    : system(std::move(lens), stop_radius_mm),
      pupil(system, half_size_mm(grid), low_nm, high_nm),
      routes{system.direct()},
      route_probability{1},
      least_cosine(pupil.min_cosine()) {
  const lens::System& of = system.system();
  constexpr int kSpeedCells = 64;  // cells across the axial beam
  const lens::SystemAt at(of, of.primary_nm());
  pinhole_distance_mm = pinhole_distance(at);
  image_distance_mm =
      finite(std::abs(of.surfaces.back().thickness_mm - lens::first_order(at).rear_principal_mm));
  if (!image_distance_mm) image_distance_mm = pinhole_distance_mm;
  speed = lens::speed(at, stop_radius_mm, kSpeedCells);
  if (ghosts == Ghosts::enumerated) enumerate_ghosts(half_size_mm(grid), low_nm, high_nm);
}

void LensOptics::enumerate_ghosts(const V2d& half_film_mm, double low_nm, double high_nm) {
  const std::vector<lens::Ghost> all = lens::ghosts(system.system(), low_nm, high_nm);
  if (all.empty()) return;
  system = lens::SpectralSystem(lens::with_clear_apertures(system, half_film_mm, low_nm, high_nm),
                                system.stop_radius_mm());
  double sum = 0;
  for (const lens::Ghost& ghost : all) sum += ghost.reflectance;
  route_probability = {1 - kGhostProbability};
  for (const lens::Ghost& ghost : all) {
    routes.push_back(lens::route_of(ghost, system.system().surfaces.size()));
    const double uniform = 1 / static_cast<double>(all.size());
    route_probability.push_back(kGhostProbability * (ghost.reflectance / sum + uniform) / 2);
  }
  least_cosine = std::min(least_cosine, steepest_cosine(system, half_film_mm));
}

}  // namespace abbe
