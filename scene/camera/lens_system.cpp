#include "scene/camera/lens_system.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "materials/bsdf/warp.h"
#include "scene/camera/lens_optics.h"
#include "scene/camera/perspective.h"

// A ray of the scene is shared by all lanes; each goes through the lens to a film point x_j of its own. What
// is conserved on the way is the étendue dG = cos dA dw, in air the same before the lens and behind it. With
// film points uniform over each pixel, of area a, and points of the tangent plane of the last vertex, at the
// distance z from the film, uniform over the bound of the exit pupil there, of area A(x), lane j as the hero
// would have drawn the ray with the density
//     p_j = [1/a] [1/A(x_j)] z^2/cos_j^4
// of étendue, cos_j being that of its angle at the film, since dG = dx dA cos^4/z^2. A lane that is blocked,
// or that falls beside the film, has p_j = 0. Radiance L adds T_j L dG/a to the irradiance of the pixel at
// x_j, T_j being what surfaces and glass let through. So, for one sample in each pixel, the balance heuristic
// over the lanes [Wilkie2014] is
//     sum_j [T_j L_j/a] / sum_k p_k,
// each term deposited at its own x_j: `weight` is T_j/(a p_hero), and `lane_pdf` p_j/p_hero. Nothing is said
// of derivatives of the lens.
//
// With ghosts, a route through the lens is drawn first, and all this holds for each of them by itself: its
// lanes are those of that route, and densities are times the probability of the route. A ghost has no pupil
// that is sharp; its rays leave film points towards points P of the last surface, drawn evenly over the clear
// aperture's area pi R^2 across the surface's own axis, which with the normal n at P and the way d is
//     p_j = q/(a pi R^2) n_z |P - x_j|^2/(cos_j (n.d)),
// and come in through points of the first surface, drawn likewise, with n_z/(pi R^2) of its own area.
//
// Towards a point of the scene no film point need be known: points of a disc of area B, which all light comes
// in through, are drawn uniformly; the intensity I sends I cos dB/d^2 through one of its elements, and T_j of
// it to the pixel at x_j. As densities of both ways are to be told in one measure, a ray counts as drawn by
// its place on that disc, with 1/B, and by its direction from there, with p_j cos B.

namespace abbe {
namespace {

using Imath::V2d;
using Imath::V2f;
using Imath::V3d;
using Imath::V3f;
using lens::kMmPerM;

// The axes of the lens in the scene: x to the right, y up, z with the light.
V3d in_lens(const CameraFrame& frame, const V3d& v) {
  return {v.dot(frame.right), v.dot(frame.up), -v.dot(frame.forward)};
}
V3d lens_in_scene(const CameraFrame& frame, const V3d& v) {
  return frame.right * v.x + frame.up * v.y - frame.forward * v.z;
}

// The real image is upside down.
V2d image_of_film(const FilmGrid& grid, const V2f& film) {
  return -kMmPerM * film_plane(grid, film);
}

double disc_area(double radius) {
  return std::numbers::pi * radius * radius;
}

V3d entrance_center(const LensSystem& camera) {
  return camera.frame.position - camera.frame.forward * (camera.optics->pupil.entrance().z / kMmPerM);
}

// Where light comes in by some route, as light tracing draws it.
struct EntrancePoint {
  V3d point;
  V3d normal;  // outward, unit
  double pdf;  // of it and the route [1/m^2]
};

double share_of(const LensSystem& camera, LensRoute route) {
  return camera.ghosts ? camera.optics->route_share[route] : 1;
}

EntrancePoint first_surface_point(const LensSystem& camera, const V2d& local, LensRoute route) {
  const lens::SurfacePoint at = camera.optics->system.point_of(0, local);
  const double area = disc_area(camera.optics->semi_aperture_mm(0) / kMmPerM);
  return {camera.frame.position + lens_in_scene(camera.frame, at.point) / kMmPerM,
          -lens_in_scene(camera.frame, at.normal), share_of(camera, route) * at.cos_axis / area};
}

EntrancePoint draw_entrance(const LensSystem& camera, const V2f& u, LensRoute route) {
  const V2d disc(concentric_disc(u));
  if (route > 0) return first_surface_point(camera, disc * camera.optics->semi_aperture_mm(0), route);
  const double radius = camera.optics->pupil.entrance().radius / kMmPerM;
  const V2d on_disc = disc * radius;
  return {entrance_center(camera) + camera.frame.right * on_disc.x + camera.frame.up * on_disc.y,
          camera.frame.forward, share_of(camera, route) / disc_area(radius)};
}

// Of a point that has been drawn so.
EntrancePoint entrance_at(const LensSystem& camera, const V3d& point, LensRoute route) {
  if (route > 0) {
    const V3d of_lens = in_lens(camera.frame, point - camera.frame.position) * kMmPerM;
    return first_surface_point(camera, camera.optics->system.local_of(0, of_lens), route);
  }
  const double radius = camera.optics->pupil.entrance().radius / kMmPerM;
  return {point, camera.frame.forward, share_of(camera, route) / disc_area(radius)};
}

// A route by one of the numbers that draw a point, which is drawn by what of the number this leaves: the
// image has the middle of the unit interval.
struct DrawnRoute {
  LensRoute route;
  V2f u;
};
float part_of(double x, double from, double size) {
  constexpr float kBelowOne = 1 - std::numeric_limits<float>::epsilon() / 2;
  return std::min(static_cast<float>((x - from) / size), kBelowOne);
}
// By x in [0, `kGhostShare`).
DrawnRoute draw_ghost(const LensOptics& optics, double x, float y) {
  const std::vector<double>& share = optics.route_share;
  double from = 0;
  LensRoute route = 1;
  while (route + 1 < share.size() && x >= from + share[route]) from += share[route++];
  return {route, {part_of(x, from, share[route]), y}};
}
DrawnRoute draw_route(const LensSystem& camera, const V2f& u) {
  if (!camera.ghosts) return {0, u};
  const auto x = static_cast<double>(u.x);
  const double image = camera.optics->route_share[0];
  const double before = (1 - image) / 2;
  if (x >= before && x < before + image) return {0, {part_of(x, before, image), u.y}};
  return draw_ghost(*camera.optics, x < before ? x : x - image, u.y);
}

// A lane of a ray where it comes to the film.
struct Landing {
  V2f film;
  double cos_film;
  double transmittance;
  double pdf;  // a p_j [1/sr]
};

V3d lane_of(const Imath::Vec3<lens::Doubles>& v, int lane) {
  return {v.x[lane], v.y[lane], v.z[lane]};
}

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

// All lanes of a ray.
struct Landings {
  LaneImages images;
  SampledSpectrum transmittance;
  SampledSpectrum pdf;
};

// Light comes along the ray against its direction. Nothing where no lane comes to the film.
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

// The ray in the scene of one from a film point to where it leaves the film's side: a point of the bound of
// its exit pupil, of a ghost one of the last surface, that a point of the unit disc stands for. It starts
// where light comes in.
std::optional<Ray> scene_ray(const LensSystem& camera, const V2d& image, const V2d& disc, LensRoute route,
                             double wavelength_nm, float time) {
  const LensOptics& optics = *camera.optics;
  const V3d from(image.x, image.y, optics.system.image_z());
  V3d to;
  if (route == 0) {
    const V2d pupil = optics.pupil.bound(image).point(disc);
    to = {pupil.x, pupil.y, optics.system.last_z()};
  } else {
    const std::size_t last = optics.last_surface();
    to = optics.system.point_of(last, disc * optics.semi_aperture_mm(last)).point;
  }
  const auto out =
      optics.system.to_object({from, (to - from).normalized()}, wavelength_nm, optics.routes[route]);
  if (!out) return std::nullopt;
  const V3d& d = out->direction;
  const V3d start =
      route == 0 ? out->origin + (optics.pupil.entrance().z - out->origin.z) / d.z * d : out->origin;
  return ray_at(V3f(camera.frame.position + lens_in_scene(camera.frame, start) / kMmPerM),
                V3f(lens_in_scene(camera.frame, d)), time);
}

}  // namespace

// Where the lens lets nothing through, the ray is that of the middle of the pupil, and weighs nothing.
CameraRay LensSystem::sample_ray(const FilmGrid& grid, V2f film, V2f lens,
                                 const SampledSpectrum& wavelengths_nm, int hero, float time) const {
  const auto nm = static_cast<double>(wavelengths_nm[hero]);
  const V2d image = image_of_film(grid, film);
  const auto [route, u] = draw_route(*this, lens);
  const auto ray = scene_ray(*this, image, V2d(concentric_disc(u)), route, nm, time);
  const auto lanes = ray ? land(*this, grid, *ray, wavelengths_nm, route) : std::nullopt;
  if (!lanes || !(lanes->pdf[hero] > 0)) {
    const auto middle_ray = scene_ray(*this, image, {0, 0}, 0, nm, time);
    return {middle_ray.value_or(ray_at(V3f(middle()), V3f(frame.forward), time)), SampledSpectrum(), 1};
  }
  const SampledSpectrum drawn(lanes->pdf[hero]);
  return {*ray, lanes->transmittance / drawn, lanes->images.cos_film[hero], lanes->pdf / drawn, lanes->images,
          route};
}

std::optional<CameraConnection> LensSystem::sample_towards(const FilmGrid& grid, const V3f& point, V2f lens,
                                                           const SampledSpectrum& wavelengths_nm,
                                                           float time) const {
  const auto [route, u] = draw_route(*this, lens);
  const EntrancePoint entrance = draw_entrance(*this, u, route);
  const V3f lens_point(entrance.point);
  const V3d way = V3d(point) - V3d(lens_point);
  const double distance = way.length();
  const double cos_theta = way.dot(entrance.normal) / distance;
  if (!(cos_theta > 0)) return std::nullopt;
  const auto lanes = land(*this, grid, ray_at(lens_point, V3f(way / distance), time), wavelengths_nm, route);
  if (!lanes) return std::nullopt;
  const double weight =
      cos_theta / (entrance.pdf * distance * distance * grid.pixel_pitch * grid.pixel_pitch);
  return CameraConnection{{lanes->images.x[0], lanes->images.y[0]},
                          lens_point,
                          lanes->transmittance * static_cast<float>(weight),
                          lanes->images.cos_film[0],
                          lanes->images,
                          route};
}

std::optional<GhostEntrance> LensSystem::sample_ghost(V2f lens) const {
  if (!ghosts) return std::nullopt;
  const auto [route, u] = draw_ghost(*optics, static_cast<double>(lens.x) * LensOptics::kGhostShare, lens.y);
  const EntrancePoint at = draw_entrance(*this, u, route);
  return GhostEntrance{V3f(at.point), V3f(at.normal), route,
                       static_cast<float>(at.pdf / LensOptics::kGhostShare)};
}

std::optional<CameraDensity> LensSystem::density(const FilmGrid& grid, const Ray& ray,
                                                 const SampledSpectrum& wavelengths_nm,
                                                 LensRoute route) const {
  const EntrancePoint entrance = entrance_at(*this, V3d(ray.origin), route);
  const double cos_theta = V3d(ray.direction).dot(entrance.normal);
  if (!(cos_theta > 0)) return std::nullopt;
  const auto lanes = land(*this, grid, ray, wavelengths_nm, route);
  if (!lanes) return std::nullopt;
  const double pixel_area = grid.pixel_pitch * grid.pixel_pitch;
  return CameraDensity{{lanes->images.x[0], lanes->images.y[0]},
                       lanes->transmittance * static_cast<float>(1 / pixel_area),
                       static_cast<float>(entrance.pdf),
                       lanes->pdf * static_cast<float>(cos_theta / (entrance.pdf * pixel_area)),
                       static_cast<float>(cos_theta),
                       lanes->images.cos_film[0],
                       lanes->images};
}

double LensSystem::least_film_cosine(const FilmGrid& /*grid*/) const {
  return optics->least_cosine;
}

V3d LensSystem::middle() const {
  return entrance_center(*this);
}

// Of ghosts the opening holds the first surface too.
CameraTraits LensSystem::traits() const {
  const double radius =
      std::max(optics->pupil.entrance().radius, ghosts ? optics->semi_aperture_mm(0) : 0.0) / kMmPerM;
  return {.depth_of_field = true,
          .displaces_lanes = true,
          .ghosts = ghosts,
          .polarises = true,
          .image_distance = optics->image_distance_mm / kMmPerM,
          .f_number = optics->speed ? std::optional(optics->speed->f_number) : std::nullopt,
          .axis = frame.forward,
          .opening =
              Opening{entrance_center(*this), frame.right * radius, frame.up * radius, frame.forward, true}};
}

}  // namespace abbe
