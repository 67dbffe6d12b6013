#include "scene/camera/lens_landing.h"

#include <array>
#include <bit>

#include "materials/bsdf/warp.h"
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
                               const lens::BasicArrival<lens::Floats>& arrival, LensRoute route, int lane) {
  if (!arrival.arrived[lane]) return std::nullopt;
  const V2d point(V2f(arrival.point.x[lane], arrival.point.y[lane]));
  const auto film = film_position(grid, -point / kMmPerM);
  if (!film) return std::nullopt;
  const V3d d(lane_of(arrival.direction, lane));
  const LensOptics& optics = *camera.optics;
  const auto pdf = route == 0 ? exit_pdf(optics, point, d)
                              : ghost_exit_pdf(optics, point, d, V3d(lane_of(arrival.last, lane)));
  if (!pdf) return std::nullopt;
  return Landing{*film, d.z, share_of(camera, route) * *pdf};
}

// Of the first packet, or of the second.
SampledSpectrum spectrum(const lens::Floats& lanes, std::size_t packet) {
  return std::bit_cast<std::array<SampledSpectrum, 2>>(lanes)[packet];
}

// From the fields that a lens leaves of those along the first axis, in the scene, and across it; 0 of lanes
// that do not arrive.
std::array<LensJones, 2> jones(const std::array<V3f, 2>& axes,
                               const lens::BasicArrival<lens::Floats>& arrival) {
  using Lanes = Imath::Vec3<lens::Floats>;
  const lens::Floats power = arrival.first.dot(arrival.first) + arrival.second.dot(arrival.second);
  const lens::Floats over_root = 1 / sqrt(select(power > 0, power * 0.5, 1));
  const Lanes y = lens::unit(arrival.direction.cross(Lanes(1, 0, 0)));  // x is the picture's right
  const Lanes x = y.cross(arrival.direction);
  const auto element = [&](const Lanes& to, const Lanes& field) {
    return select(arrival.arrived, to.dot(field) * over_root, 0);
  };
  const lens::Floats xx = element(x, arrival.first);
  const lens::Floats xy = element(x, arrival.second);
  const lens::Floats yx = element(y, arrival.first);
  const lens::Floats yy = element(y, arrival.second);
  const auto of = [&](std::size_t packet) {
    return LensJones{axes[packet], spectrum(xx, packet), spectrum(xy, packet), spectrum(yx, packet),
                     spectrum(yy, packet)};
  };
  return {of(0), of(1)};
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

namespace {

lens::Ray towards_film(const LensSystem& camera, const Ray& ray) {
  return {in_lens(camera.frame, V3d(ray.origin) - camera.frame.position) * kMmPerM,
          -in_lens(camera.frame, V3d(ray.direction)).normalized()};
}

// Of the first packet, or of the second; its polarisation is left open.
std::optional<Landings> landings(const LensSystem& camera, const FilmGrid& grid,
                                 const lens::BasicArrival<lens::Floats>& arrival, LensRoute route,
                                 std::size_t packet) {
  std::array<std::optional<Landing>, kLanes> lanes;
  const Landing* any = nullptr;
  for (std::size_t j = 0; j < kLanes; ++j) {
    lanes[j] = landing(camera, grid, arrival, route, static_cast<int>(packet * kLanes + j));
    if (lanes[j] && any == nullptr) any = &*lanes[j];
  }
  if (any == nullptr) return std::nullopt;
  std::array<SampledSpectrum::Values, 4> of{};
  SampledSpectrum::Values drawn{};
  for (std::size_t j = 0; j < kLanes; ++j) {
    const Landing& lane = lanes[j] ? *lanes[j] : *any;
    of[0][j] = lane.film.x;
    of[1][j] = lane.film.y;
    of[2][j] = static_cast<float>(lane.cos_film);
    if (!lanes[j]) continue;
    of[3][j] = static_cast<float>(lane.pdf);
    drawn[j] = 1;
  }
  const SampledSpectrum transmittance =
      SampledSpectrum::map(spectrum(arrival.transmittance, packet), SampledSpectrum(drawn),
                           [](float passes, float there) { return there > 0 ? passes : 0; });
  return Landings{{SampledSpectrum(of[0]), SampledSpectrum(of[1]), SampledSpectrum(of[2])},
                  transmittance,
                  SampledSpectrum(of[3])};
}

}  // namespace

std::array<std::optional<Landings>, 2> land_two(const LensSystem& camera, const FilmGrid& grid,
                                                const std::array<LandingRay, 2>& rays, LensRoute route) {
  const lens::Ray first = towards_film(camera, rays[0].ray);
  const lens::Ray second = towards_film(camera, rays[1].ray);
  const auto arrival = camera.optics->system.to_image(
      {{{first, rays[0].wavelengths_nm}, {second, rays[1].wavelengths_nm}}}, camera.optics->routes[route]);
  const auto axis = [&](const lens::Ray& ray) {
    return V3f(lens_in_scene(camera.frame, lens::WeakenedLight<double>(ray.direction).first()));
  };
  const std::array<LensJones, 2> matrices = jones({axis(first), axis(second)}, arrival);
  std::array<std::optional<Landings>, 2> landed;
  for (std::size_t packet : {0U, 1U}) {
    landed[packet] = landings(camera, grid, arrival, route, packet);
    if (landed[packet]) landed[packet]->images.jones = matrices[packet];
  }
  return landed;
}

}  // namespace abbe
