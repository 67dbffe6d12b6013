#include "scene/camera/lens_system.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "materials/bsdf/warp.h"
#include "scene/camera/camera_rays.h"
#include "scene/camera/lens_landing.h"
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
// its place on that disc, with 1/B, and by its direction from there, with p_j cos B. The disc is that of the
// entrance pupil; where this lies within the lens, rays begin and end in the plane of the first vertex, and d
// counts from the disc all the same. In that plane, where the rays of one direction are as dense as on the
// disc, those of one scene point are closer together: (d/d')^2 times as dense, d' being the distance from
// there.

namespace abbe {
namespace {

using Imath::V2d;
using Imath::V2f;
using Imath::V3d;
using Imath::V3f;
using lens::kMmPerM;

// The real image is upside down.
V2d image_of_film(const FilmGrid& grid, const V2f& film) {
  return -kMmPerM * film_plane(grid, film);
}

V3d on_axis(const LensSystem& camera, double z_mm) {
  return camera.frame.position - camera.frame.forward * (z_mm / kMmPerM);
}

// Where rays of the image begin and end: in the plane of the first vertex, as nothing of the scene is within
// the lens, or in that of an entrance pupil before it.
double front_z(const LensSystem& camera) {
  return std::min(camera.optics->pupil.entrance().z, 0.0);
}

// Holds where all rays of the image cross that plane: each comes through the disc of the entrance pupil, and,
// where this lies behind the first surface, past that one's rim.
double front_radius(const LensSystem& camera) {
  const auto [pupil_z, pupil_radius] = camera.optics->pupil.entrance();
  if (pupil_z <= 0) return pupil_radius;
  const lens::Surface& first = camera.optics->system.system().surfaces.front();
  const double rim = camera.optics->semi_aperture_mm(0) + first.decenter_mm.length();
  const double rim_z = camera.optics->system.point_of(0, {camera.optics->semi_aperture_mm(0), 0}).point.z;
  const double widens = rim_z > 0 && rim_z < pupil_z ? rim_z * (rim + pupil_radius) / (pupil_z - rim_z) : 0;
  return std::max(rim, pupil_radius) + widens;
}

// Where light comes in by some route, as light tracing draws it.
struct EntrancePoint {
  V3d point;
  V3d normal;  // outward, unit
  double pdf;  // of it and the route [1/m^2]
};

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
  return {on_axis(camera, camera.optics->pupil.entrance().z) + camera.frame.right * on_disc.x +
              camera.frame.up * on_disc.y,
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

// From a film point to where it leaves the film's side: a point of the bound of its exit pupil, of a ghost
// one of the last surface, that a point of the unit disc stands for.
lens::Ray from_film(const LensSystem& camera, const V2d& image, const V2d& disc, LensRoute route) {
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
  return {from, (to - from).normalized()};
}

// Of one that has left the lens, from where light comes in by its route.
Ray in_scene(const LensSystem& camera, const lens::Ray& out, LensRoute route, float time) {
  const V3d& d = out.direction;
  const V3d start = route == 0 ? out.origin + (front_z(camera) - out.origin.z) / d.z * d : out.origin;
  return ray_at(V3f(camera.frame.position + lens_in_scene(camera.frame, start) / kMmPerM),
                V3f(lens_in_scene(camera.frame, d)), time);
}

// Of a sample whose ray comes to the film as its lanes do; nothing where light would not be drawn.
std::optional<CameraRay> camera_ray(const CameraSample& sample, LensRoute route, const Ray& ray,
                                    const std::optional<Landings>& lanes) {
  if (!lanes || !(lanes->pdf[sample.hero] > 0)) return std::nullopt;
  const SampledSpectrum drawn(lanes->pdf[sample.hero]);
  return CameraRay{ray,
                   lanes->transmittance / drawn,
                   lanes->images.cos_film[sample.hero],
                   lanes->pdf / drawn,
                   lanes->images,
                   route};
}

// Of a sample for which nothing comes through the lens: that of the middle of the pupil, which weighs
// nothing.
CameraRay dark_ray(const LensSystem& camera, const FilmGrid& grid, const CameraSample& sample) {
  const auto middle =
      camera.optics->system.to_object(from_film(camera, image_of_film(grid, sample.film), {0, 0}, 0),
                                      static_cast<double>(sample.wavelengths_nm[sample.hero]));
  const Ray ray = middle ? in_scene(camera, *middle, 0, sample.time)
                         : ray_at(V3f(camera.middle()), V3f(camera.frame.forward), sample.time);
  return {ray, SampledSpectrum(), 1};
}

}  // namespace

CameraRay LensSystem::sample_ray(const FilmGrid& grid, V2f film, V2f lens,
                                 const SampledSpectrum& wavelengths_nm, int hero, float time) const {
  const CameraSample sample{film, lens, wavelengths_nm, hero, time};
  const auto [route, u] = draw_route(*this, lens);
  const auto out =
      optics->system.to_object(from_film(*this, image_of_film(grid, film), V2d(concentric_disc(u)), route),
                               static_cast<double>(wavelengths_nm[hero]), optics->routes[route]);
  if (!out) return dark_ray(*this, grid, sample);
  const Ray ray = in_scene(*this, *out, route, time);
  const auto drawn = camera_ray(sample, route, ray, land(*this, grid, {ray, wavelengths_nm}, route));
  return drawn ? *drawn : dark_ray(*this, grid, sample);
}

void sample_rays(const LensSystem& camera, const FilmGrid& grid, std::span<const CameraSample> samples,
                 std::span<CameraRay> rays) {
  const CameraRay dark{ray_at(V3f(camera.middle()), V3f(camera.frame.forward), 0), SampledSpectrum(), 1};
  std::vector<lens::ColouredRay> of_image;
  std::vector<std::size_t> sample_of;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto& [film, lens, wavelengths_nm, hero, time] = samples[i];
    const auto [route, u] = draw_route(camera, lens);
    rays[i] = route > 0 ? camera.sample_ray(grid, film, lens, wavelengths_nm, hero, time) : dark;
    if (route > 0) continue;
    of_image.push_back({from_film(camera, image_of_film(grid, film), V2d(concentric_disc(u)), route),
                        static_cast<double>(wavelengths_nm[hero])});
    sample_of.push_back(i);
  }
  std::vector<std::size_t> left;  // the lens
  std::vector<LandingRay> out;
  const auto leaving = camera.optics->system.to_object(of_image);
  for (std::size_t k = 0; k < leaving.size(); ++k) {
    if (!leaving[k]) continue;
    const CameraSample& sample = samples[left.emplace_back(sample_of[k])];
    out.push_back({in_scene(camera, *leaving[k], 0, sample.time), sample.wavelengths_nm});
  }
  for (std::size_t k = 0; k < out.size(); k += 2) {
    const std::size_t other = std::min(k + 1, out.size() - 1);
    const auto lanes = land_two(camera, grid, {out[k], out[other]}, 0);
    for (const std::size_t of : {k, other})
      if (const auto ray = camera_ray(samples[left[of]], 0, out[of].ray, lanes[of - k]))
        rays[left[of]] = *ray;
  }
}

std::optional<CameraConnection> LensSystem::sample_towards(const FilmGrid& grid, const V3f& point, V2f lens,
                                                           const SampledSpectrum& wavelengths_nm,
                                                           float time) const {
  const auto [route, u] = draw_route(*this, lens);
  const EntrancePoint entrance = draw_entrance(*this, u, route);
  const V3d way = V3d(point) - entrance.point;
  const double distance = way.length();
  const double cos_theta = way.dot(entrance.normal) / distance;
  const double behind = route == 0 ? (optics->pupil.entrance().z - front_z(*this)) / kMmPerM : 0;
  if (!(cos_theta > 0 && distance * cos_theta > behind)) return std::nullopt;
  const double from_disc = behind / cos_theta;  // along the ray, to the lens point
  const V3f lens_point(entrance.point + way / distance * from_disc);
  const double farther = distance / (distance - from_disc);
  const auto lanes =
      land(*this, grid, {ray_at(lens_point, V3f(way / distance), time), wavelengths_nm}, route);
  if (!lanes) return std::nullopt;
  const double weight =
      cos_theta / (entrance.pdf * distance * distance * grid.pixel_pitch * grid.pixel_pitch);
  return CameraConnection{{lanes->images.x[0], lanes->images.y[0]},
                          lens_point,
                          static_cast<float>(entrance.pdf * farther * farther),
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
  const auto lanes = land(*this, grid, {ray, wavelengths_nm}, route);
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
  return on_axis(*this, front_z(*this));
}

// Of ghosts the opening holds the first surface too.
CameraTraits LensSystem::traits() const {
  const bool numbered = optics->speed && std::isfinite(optics->speed->f_number);
  const auto in_m = [](const std::optional<double>& mm) {
    return mm ? std::optional(*mm / kMmPerM) : std::nullopt;
  };
  const double radius = std::max(front_radius(*this), ghosts ? optics->semi_aperture_mm(0) : 0.0) / kMmPerM;
  return {.depth_of_field = true,
          .displaces_lanes = true,
          .ghosts = ghosts,
          .polarises = true,
          .image_distance = in_m(optics->image_distance_mm),
          .pinhole_distance = in_m(optics->pinhole_distance_mm),
          .f_number = numbered ? std::optional(optics->speed->f_number) : std::nullopt,
          .axis = frame.forward,
          .opening = FlatOpening{middle(), frame.right * radius, frame.up * radius, frame.forward, true}};
}

}  // namespace abbe
