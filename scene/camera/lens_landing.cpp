#include "scene/camera/lens_landing.h"

#include <array>

#include "scene/camera/lens_optics.h"
#include "scene/camera/perspective.h"

// The densities p_j here are those of `lens_system.cpp`.

namespace abbe {
namespace {

using Imath::V2d;
using Imath::V2f;
using Imath::V3d;
using Imath::V3f;
using lens::kMmPerM;

// A lane of a ray where it comes to the film.
struct Landing {
  V2f film;
  double cos_film;
  double transmittance;
  double pdf;  // a p_j [1/sr]
};

// Of the direction in which a lane comes from the lens to a film point: nothing where it would not be drawn
// by way of the image, beside the bound of its exit pupil.
std::optional<double> exit_pdf(const LensOptics& optics, const V2d& image, const V3d& d) {
  const double depth = optics.system.image_z() - optics.system.last_z();
  const lens::PupilBound bound = optics.pupil.bound(image);
  if (!bound.contains(image - V2d(d.x, d.y) * (depth / d.z))) return std::nullopt;
  const double cos2 = d.z * d.z;
  return depth * depth / (bound.area() * cos2 * cos2);
}

// By way of a ghost, from a point of the last surface.
double ghost_exit_pdf(const LensOptics& optics, const V2d& image, const V3d& d, const V3d& last) {
  const std::size_t surface = optics.last_surface();
  const lens::SurfacePoint at = optics.system.point_of(surface, optics.system.local_of(surface, last));
  const double distance2 = (V3d(image.x, image.y, optics.system.image_z()) - last).length2();
  return at.cos_axis * distance2 / (disc_area(optics.semi_aperture_mm(surface)) * d.z * at.normal.dot(d));
}

// Nothing for a lane that does not get to the film, or would not be drawn.
std::optional<Landing> landing(const LensSystem& camera, const FilmGrid& grid,
                               const lens::BasicArrival<lens::Doubles>& arrival, LensRoute route, int lane) {
  if (!arrival.arrived[lane]) return std::nullopt;
  const V2d point(arrival.point.x[lane], arrival.point.y[lane]);
  const auto film = film_position(grid, -point / kMmPerM);
  if (!film) return std::nullopt;
  const V3d d = lane_of(arrival.direction, lane);
  const LensOptics& optics = *camera.optics;
  const auto pdf =
      route == 0 ? exit_pdf(optics, point, d) : ghost_exit_pdf(optics, point, d, lane_of(arrival.last, lane));
  if (!pdf) return std::nullopt;
  return Landing{*film, d.z, arrival.transmittance[lane], share_of(camera, route) * *pdf};
}

SampledSpectrum to_floats(const lens::Doubles& lanes) {
  SampledSpectrum::Values values{};
  for (int j = 0; j < kLanes; ++j) values[static_cast<std::size_t>(j)] = static_cast<float>(lanes[j]);
  return SampledSpectrum(values);
}

// From the fields that a lens leaves of those along the first axis, in the scene, and across it.
LensJones jones(const V3f& axis, const lens::BasicArrival<lens::Doubles>& arrival) {
  using Lanes = Imath::Vec3<lens::Doubles>;
  const lens::Doubles power = arrival.first.dot(arrival.first) + arrival.second.dot(arrival.second);
  const lens::Doubles over_root = 1 / sqrt(select(power > 0, power * 0.5, 1));
  const Lanes y = lens::unit(arrival.direction.cross(Lanes(1, 0, 0)));  // x is the picture's right
  const Lanes x = y.cross(arrival.direction);
  const auto element = [&](const Lanes& to, const Lanes& field) {
    return to_floats(to.dot(field) * over_root);
  };
  return {axis, element(x, arrival.first), element(x, arrival.second), element(y, arrival.first),
          element(y, arrival.second)};
}

}  // namespace

V3d in_lens(const CameraFrame& frame, const V3d& v) {
  return {v.dot(frame.right), v.dot(frame.up), -v.dot(frame.forward)};
}
V3d lens_in_scene(const CameraFrame& frame, const V3d& v) {
  return frame.right * v.x + frame.up * v.y - frame.forward * v.z;
}

double share_of(const LensSystem& camera, LensRoute route) {
  return camera.ghosts ? camera.optics->route_share[route] : 1;
}

std::optional<Landings> land(const LensSystem& camera, const FilmGrid& grid, const Ray& ray,
                             const SampledSpectrum& wavelengths_nm, LensRoute route) {
  const lens::Ray of_lens{in_lens(camera.frame, V3d(ray.origin) - camera.frame.position) * kMmPerM,
                          -in_lens(camera.frame, V3d(ray.direction)).normalized()};
  const auto arrival = camera.optics->system.to_image(of_lens, wavelengths_nm, camera.optics->routes[route]);
  std::array<std::optional<Landing>, kLanes> lanes;
  const Landing* any = nullptr;
  for (std::size_t j = 0; j < kLanes; ++j) {
    lanes[j] = landing(camera, grid, arrival, route, static_cast<int>(j));
    if (lanes[j] && any == nullptr) any = &*lanes[j];
  }
  if (any == nullptr) return std::nullopt;
  std::array<SampledSpectrum::Values, 5> of{};
  for (std::size_t j = 0; j < kLanes; ++j) {
    const Landing& lane = lanes[j] ? *lanes[j] : *any;
    of[0][j] = lane.film.x;
    of[1][j] = lane.film.y;
    of[2][j] = static_cast<float>(lane.cos_film);
    if (!lanes[j]) continue;
    of[3][j] = static_cast<float>(lane.transmittance);
    of[4][j] = static_cast<float>(lane.pdf);
  }
  const V3f axis(lens_in_scene(camera.frame, lens::WeakenedLight<double>(of_lens.direction).first()));
  return Landings{
      {SampledSpectrum(of[0]), SampledSpectrum(of[1]), SampledSpectrum(of[2]), jones(axis, arrival)},
      SampledSpectrum(of[3]),
      SampledSpectrum(of[4])};
}

}  // namespace abbe
