#include "scene/camera/lens_system.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "materials/bsdf/warp.h"
#include "scene/camera/camera.h"
#include "scene/camera/lens_optics.h"
#include "scene/camera/perspective.h"

// A scene ray is shared by all wavelengths. Each one passes the lens to a film point x_j of its own. The
// étendue dG = cos dA dw is conserved, and has the same form in air on both sides of the lens.
//
// Film points are uniform over each pixel, of area a. Points in the tangent plane of the last vertex, at the
// distance z from the film, are uniform over the bound of the exit pupil, of area A(x). Wavelength j as
// the hero has the density in étendue
//     p_j = [1/a] [1/A(x_j)] z^2/cos_j^4,
// where cos_j is that of its angle at the film, since dG = dx dA cos^4/z^2. A wavelength that is blocked, or
// that misses the film, has p_j = 0. Radiance L adds T_j L dG/a to the irradiance of the pixel at x_j, where
// T_j is the transmittance of surfaces and glass. For one sample per pixel, the balance heuristic over
// wavelengths [Wilkie2014] gives
//     sum_j [T_j L_j/a] / sum_k p_k,
// with each term deposited at its own x_j. Hence `weight` is T_j/(a p_hero), and `lane_pdf` is p_j/p_hero. No
// derivatives of the lens are needed.
//
// With ghosts, a route through the lens is sampled first, and all this holds for each route by itself: its
// wavelengths take that route, and densities are multiplied by its probability q. A ghost has no sharp pupil.
// Its rays leave film points towards points P of the last surface, sampled uniformly over the clear
// aperture's area pi R^2 perpendicular to the surface's own axis. With the normal n at P and the direction d,
//     p_j = q/(a pi R^2) n_z |P - x_j|^2/(cos_j (n.d)).
// They enter through points of the first surface, sampled in the same way, with the density n_z/(pi R^2) in
// its own area.
//
// Towards a scene point no film point need be known. Points are sampled uniformly on a disc of area B through
// which all light enters. Intensity I sends I cos dB/d^2 through an element of it, and T_j of that to the
// pixel at x_j. Both directions of sampling need densities in the same measure. Therefore a ray is described
// by its point on the disc, with 1/B, and by its direction there, with p_j cos B. The disc is the entrance
// pupil. If that lies inside the lens, rays begin and end in the plane of the first vertex, while d still
// counts from the disc. In that plane the rays of one direction are as dense as on the disc. Those of one
// scene point are (d/d')^2 times denser, where d' is the distance from the plane.

namespace abbe {
namespace {

using Imath::V2d;
using Imath::V2f;
using Imath::V3d;
using Imath::V3f;
using lens::kMmPerM;

// Converts a vector, without a shift or a change of unit, from render coordinates to the axes of the lens: x
// along `right`, y along `up`, z against `forward`, as light propagates.
V3d to_lens(const CameraFrame& frame, const V3d& v) {
  return {v.dot(frame.right), v.dot(frame.up), -v.dot(frame.forward)};
}
// Inverse of `to_lens`.
V3d from_lens(const CameraFrame& frame, const V3d& v) {
  return frame.right * v.x + frame.up * v.y - frame.forward * v.z;
}

// Probability with which a camera ray takes a route through the lens; 1 if the camera has no ghosts.
double route_probability(const LensSystem& camera, LensRoute route) {
  return camera.ghosts ? camera.optics->route_probability[route] : 1;
}

// The film positions of all wavelengths of a ray.
struct FilmHits {
  WavelengthImages images;
  SampledSpectrum transmittance;  // Of the lens, in [0, 1]; 0 for wavelengths that do not arrive.
  // Density in étendue that each wavelength as the hero would have, times the area of a pixel [1/sr]. It
  // includes `route_probability`; 0 for wavelengths that do not arrive.
  SampledSpectrum pdf;
};
// A ray from the lens into the scene, in render coordinates, and the wavelengths along it.
struct SceneRay {
  Ray ray;
  SampledSpectrum wavelengths_nm;
};

// The hit of one wavelength on the film.
struct FilmHit {
  V2f film;
  double cos_film;
  double pdf;  // p_j [1/sr]
};

// Pdf of the direction of a wavelength from the lens to a film point. Nothing if the image's route would not
// sample it, outside the bound of the exit pupil.
std::optional<double> exit_pdf(const LensOptics& optics, const V2d& image, const V3d& d) {
  const double depth = optics.system.image_z() - optics.system.last_z();
  const lens::PupilBound bound = optics.pupil.bound(image);
  if (!bound.contains(image - V2d(d.x, d.y) * (depth / d.z))) return std::nullopt;
  const double cos2 = d.z * d.z;
  return depth * depth / (bound.area() * cos2 * cos2);
}

// Pdf of that direction for the route of a ghost, from a point of the last surface.
double ghost_exit_pdf(const LensOptics& optics, const V2d& image, const V3d& d, const V3d& last) {
  const std::size_t surface = optics.last_surface();
  const lens::SurfacePoint at = optics.system.point_of(surface, optics.system.local_of(surface, last));
  const double distance2 = (V3d(image.x, image.y, optics.system.image_z()) - last).length2();
  return at.cos_axis * distance2 / (disc_area(optics.semi_aperture_mm(surface)) * d.z * at.normal.dot(d));
}

// The film hit of one wavelength; nothing if it does not arrive or would not be sampled.
std::optional<FilmHit> landing(const LensSystem& camera, const FilmGrid& grid,
                               const lens::BasicImageRay<lens::Floats>& arrival, LensRoute route, int lane) {
  if (!arrival.reached_image[lane]) return std::nullopt;
  const V2d point(V2f(arrival.point.x[lane], arrival.point.y[lane]));
  const auto film = film_position(grid, -point / kMmPerM);
  if (!film) return std::nullopt;
  const V3d d(lane_of(arrival.direction, lane));
  const LensOptics& optics = *camera.optics;
  const auto pdf = route == 0 ? exit_pdf(optics, point, d)
                              : ghost_exit_pdf(optics, point, d, V3d(lane_of(arrival.last, lane)));
  if (!pdf) return std::nullopt;
  return FilmHit{*film, d.z, route_probability(camera, route) * *pdf};
}

// Spectrum of the first or the second packet.
SampledSpectrum spectrum(const lens::Floats& lanes, std::size_t packet) {
  return std::bit_cast<std::array<SampledSpectrum, 2>>(lanes)[packet];
}

// Jones matrices from the fields behind the lens of incident fields along the first axis, in the scene, and
// along the second; 0 for wavelengths that do not arrive.
std::array<LensJones, 2> jones(const std::array<V3f, 2>& axes,
                               const lens::BasicImageRay<lens::Floats>& arrival) {
  using Lanes = Imath::Vec3<lens::Floats>;
  const lens::Floats power = arrival.first.dot(arrival.first) + arrival.second.dot(arrival.second);
  const lens::Floats over_root = 1 / sqrt(select(power > 0, power * 0.5, 1));
  const Lanes y = lens::unit(arrival.direction.cross(Lanes(1, 0, 0)));  // x is the picture's right
  const Lanes x = y.cross(arrival.direction);
  const auto element = [&](const Lanes& to, const Lanes& field) {
    return select(arrival.reached_image, to.dot(field) * over_root, 0);
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

lens::Ray towards_film(const LensSystem& camera, const Ray& ray) {
  return {to_lens(camera.frame, V3d(ray.origin) - camera.frame.position) * kMmPerM,
          -to_lens(camera.frame, V3d(ray.direction)).normalized()};
}

// Film hits of the first or the second packet, without polarisation.
std::optional<FilmHits> landings(const LensSystem& camera, const FilmGrid& grid,
                                 const lens::BasicImageRay<lens::Floats>& arrival, LensRoute route,
                                 std::size_t packet) {
  std::array<std::optional<FilmHit>, kLanes> lanes;
  const FilmHit* any = nullptr;
  for (std::size_t j = 0; j < kLanes; ++j) {
    lanes[j] = landing(camera, grid, arrival, route, static_cast<int>(packet * kLanes + j));
    if (lanes[j] && any == nullptr) any = &*lanes[j];
  }
  if (any == nullptr) return std::nullopt;
  std::array<SampledSpectrum::Values, 4> of{};
  SampledSpectrum::Values drawn{};
  for (std::size_t j = 0; j < kLanes; ++j) {
    const FilmHit& lane = lanes[j] ? *lanes[j] : *any;
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
  return FilmHits{{SampledSpectrum(of[0]), SampledSpectrum(of[1]), SampledSpectrum(of[2])},
                  transmittance,
                  SampledSpectrum(of[3])};
}

// Traces light along two rays, against their directions, by one route to the film. Nothing for a ray of
// which no wavelength arrives on the film at a place and angle that `sample_ray` can sample.
std::array<std::optional<FilmHits>, 2> trace_pair_to_film(const LensSystem& camera, const FilmGrid& grid,
                                                          const std::array<SceneRay, 2>& rays,
                                                          LensRoute route) {
  const lens::Ray first = towards_film(camera, rays[0].ray);
  const lens::Ray second = towards_film(camera, rays[1].ray);
  const auto arrival = camera.optics->system.to_image(
      {{{first, rays[0].wavelengths_nm}, {second, rays[1].wavelengths_nm}}}, camera.optics->routes[route]);
  const auto axis = [&](const lens::Ray& ray) {
    return V3f(from_lens(camera.frame, lens::UnpolarisedFields<double>(ray.direction).first()));
  };
  const std::array<LensJones, 2> matrices = jones({axis(first), axis(second)}, arrival);
  std::array<std::optional<FilmHits>, 2> landed;
  for (std::size_t packet : {0U, 1U}) {
    landed[packet] = landings(camera, grid, arrival, route, packet);
    if (landed[packet]) landed[packet]->images.jones = matrices[packet];
  }
  return landed;
}

// Traces one ray, as `trace_pair_to_film` does.
std::optional<FilmHits> trace_to_film(const LensSystem& camera, const FilmGrid& grid, const SceneRay& ray,
                                      LensRoute route) {
  return trace_pair_to_film(camera, grid, {ray, ray}, route)[0];
}

// The real image is inverted.
V2d image_of_film(const FilmGrid& grid, const V2f& film) {
  return -kMmPerM * film_plane(grid, film);
}

V3d on_axis(const LensSystem& camera, double z_mm) {
  return camera.frame.position - camera.frame.forward * (z_mm / kMmPerM);
}

// z of the plane in which rays of the image begin and end: that of the first vertex, because no object lies
// inside the lens, or that of an entrance pupil in front of it.
double front_z(const LensSystem& camera) {
  return std::min(camera.optics->pupil.entrance().z, 0.0);
}

// Radius that contains the points where rays of the image cross that plane. Each ray passes the disc of the
// entrance pupil and, if that lies behind the first surface, the rim of the first surface. Without a clear
// aperture there, the traced rays are the bound.
double front_radius(const LensSystem& camera) {
  const auto [pupil_z, pupil_radius] = camera.optics->pupil.entrance();
  if (pupil_z <= 0) return pupil_radius;
  const lens::Surface& first = camera.optics->system.system().surfaces.front();
  if (!first.semi_aperture_mm) return camera.optics->pupil.front_radius();
  const double rim = camera.optics->semi_aperture_mm(0) + first.decenter_mm.length();
  const double rim_z = camera.optics->system.point_of(0, {camera.optics->semi_aperture_mm(0), 0}).point.z;
  const double widening = rim_z > 0 && rim_z < pupil_z ? rim_z * (rim + pupil_radius) / (pupil_z - rim_z) : 0;
  return std::max(rim, pupil_radius) + widening;
}

// Point at which light enters by some route, as light tracing samples it.
struct EntrancePoint {
  V3d point;
  V3d normal;  // outward, unit
  double pdf;  // joint density of point and route [1/m^2]
};

EntrancePoint first_surface_point(const LensSystem& camera, const V2d& local, LensRoute route) {
  const lens::SurfacePoint at = camera.optics->system.point_of(0, local);
  const double area = disc_area(camera.optics->semi_aperture_mm(0) / kMmPerM);
  return {camera.frame.position + from_lens(camera.frame, at.point) / kMmPerM,
          -from_lens(camera.frame, at.normal), route_probability(camera, route) * at.cos_axis / area};
}

// A point of the entrance pupil, on the route of the image.
EntrancePoint pupil_point(const LensSystem& camera, const V3d& point) {
  const double radius = camera.optics->pupil.entrance().radius / kMmPerM;
  return {point, camera.frame.forward, route_probability(camera, 0) / disc_area(radius)};
}

EntrancePoint draw_entrance(const LensSystem& camera, const V2f& u, LensRoute route) {
  const V2d disc(concentric_disc(u));
  if (route > 0) return first_surface_point(camera, disc * camera.optics->semi_aperture_mm(0), route);
  const V2d on_disc = disc * (camera.optics->pupil.entrance().radius / kMmPerM);
  const V3d center = on_axis(camera, camera.optics->pupil.entrance().z);
  return pupil_point(camera, center + camera.frame.right * on_disc.x + camera.frame.up * on_disc.y);
}

// The entrance for a point that has been sampled in this way.
EntrancePoint entrance_at(const LensSystem& camera, const V3d& point, LensRoute route) {
  if (route > 0) {
    const V3d in_lens = to_lens(camera.frame, point - camera.frame.position) * kMmPerM;
    return first_surface_point(camera, camera.optics->system.local_of(0, in_lens), route);
  }
  return pupil_point(camera, point);
}

// A route, sampled by one of the random numbers for a point, and the number rescaled for reuse. The image
// takes the center of the unit interval.
struct DrawnRoute {
  LensRoute route;
  V2f u;
};
float rescaled(double x, double from, double size) {
  constexpr float kBelowOne = 1 - std::numeric_limits<float>::epsilon() / 2;
  return std::min(static_cast<float>((x - from) / size), kBelowOne);
}
// Selects a ghost by x in [0, `kGhostProbability`).
DrawnRoute draw_ghost(const LensOptics& optics, double x, float y) {
  const std::vector<double>& probabilities = optics.route_probability;
  double from = 0;
  LensRoute route = 1;
  while (route + 1 < probabilities.size() && x >= from + probabilities[route]) from += probabilities[route++];
  return {route, {rescaled(x, from, probabilities[route]), y}};
}
DrawnRoute draw_route(const LensSystem& camera, const V2f& u) {
  if (!camera.ghosts) return {0, u};
  const auto x = static_cast<double>(u.x);
  const double image = camera.optics->route_probability[0];
  const double before = (1 - image) / 2;
  if (x >= before && x < before + image) return {0, {rescaled(x, before, image), u.y}};
  return draw_ghost(*camera.optics, x < before ? x : x - image, u.y);
}

// Ray from a film point towards the lens. Its target is the point of the exit pupil's bound, or of a ghost's
// last surface, that corresponds to a point of the unit disc.
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

// Scene ray of a ray that has left the lens, from the entrance surface of its route.
Ray in_scene(const LensSystem& camera, const lens::Ray& out, LensRoute route, float time) {
  const V3d& d = out.direction;
  const V3d start = route == 0 ? out.origin + (front_z(camera) - out.origin.z) / d.z * d : out.origin;
  return ray_at(V3f(camera.frame.position + from_lens(camera.frame, start) / kMmPerM),
                V3f(from_lens(camera.frame, d)), time);
}

// The camera ray of a sample and its film hits; nothing if it would not be sampled.
std::optional<CameraRay> camera_ray(const CameraSample& sample, LensRoute route, const Ray& ray,
                                    const std::optional<FilmHits>& lanes) {
  if (!lanes || !(lanes->pdf[sample.hero] > 0)) return std::nullopt;
  const SampledSpectrum drawn(lanes->pdf[sample.hero]);
  return CameraRay{ray,
                   lanes->transmittance / drawn,
                   lanes->images.cos_film[sample.hero],
                   lanes->pdf / drawn,
                   lanes->images,
                   route};
}

// The camera ray of a sample that the lens blocks: through the center of the pupil, with zero weight.
CameraRay dark_ray(const LensSystem& camera, const FilmGrid& grid, const CameraSample& sample) {
  const auto central =
      camera.optics->system.to_object(from_film(camera, image_of_film(grid, sample.film), {0, 0}, 0),
                                      static_cast<double>(sample.wavelengths_nm[sample.hero]));
  const Ray ray = central ? in_scene(camera, *central, 0, sample.time)
                          : ray_at(V3f(camera.center()), V3f(camera.frame.forward), sample.time);
  return {ray, SampledSpectrum(), 1};
}

}  // namespace

CameraRay LensSystem::sample_ray(const FilmGrid& grid, const CameraSample& sample) const {
  const auto [route, u] = draw_route(*this, sample.lens);
  const auto out = optics->system.to_object(
      from_film(*this, image_of_film(grid, sample.film), V2d(concentric_disc(u)), route),
      static_cast<double>(sample.wavelengths_nm[sample.hero]), optics->routes[route]);
  if (!out) return dark_ray(*this, grid, sample);
  const Ray ray = in_scene(*this, *out, route, sample.time);
  const auto drawn =
      camera_ray(sample, route, ray, trace_to_film(*this, grid, {ray, sample.wavelengths_nm}, route));
  return drawn ? *drawn : dark_ray(*this, grid, sample);
}

void sample_rays(const LensSystem& camera, const FilmGrid& grid, std::span<const CameraSample> samples,
                 std::span<CameraRay> rays) {
  const CameraRay dark{ray_at(V3f(camera.center()), V3f(camera.frame.forward), 0), SampledSpectrum(), 1};
  std::vector<lens::ColouredRay> of_image;
  std::vector<std::size_t> sample_of;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const CameraSample& sample = samples[i];
    const auto [route, u] = draw_route(camera, sample.lens);
    rays[i] = route > 0 ? camera.sample_ray(grid, sample) : dark;
    if (route > 0) continue;
    of_image.push_back({from_film(camera, image_of_film(grid, sample.film), V2d(concentric_disc(u)), route),
                        static_cast<double>(sample.wavelengths_nm[sample.hero])});
    sample_of.push_back(i);
  }
  std::vector<std::size_t> sample_of_ray;  // index of the sample of each ray in `out`
  std::vector<SceneRay> out;
  const auto leaving = camera.optics->system.to_object(of_image);
  for (std::size_t k = 0; k < leaving.size(); ++k) {
    if (!leaving[k]) continue;
    const CameraSample& sample = samples[sample_of_ray.emplace_back(sample_of[k])];
    out.push_back({in_scene(camera, *leaving[k], 0, sample.time), sample.wavelengths_nm});
  }
  for (std::size_t k = 0; k < out.size(); k += 2) {
    const std::size_t other = std::min(k + 1, out.size() - 1);
    const auto lanes = trace_pair_to_film(camera, grid, {out[k], out[other]}, 0);
    for (const std::size_t of : {k, other})
      if (const auto ray = camera_ray(samples[sample_of_ray[of]], 0, out[of].ray, lanes[of - k]))
        rays[sample_of_ray[of]] = *ray;
  }
}

std::optional<CameraConnection> LensSystem::sample_towards(const FilmGrid& grid, const V3f& point,
                                                           const CameraSample& sample) const {
  const auto [route, u] = draw_route(*this, sample.lens);
  const EntrancePoint entrance = draw_entrance(*this, u, route);
  const V3d to_point = V3d(point) - entrance.point;
  const double distance = to_point.length();
  const double cos_theta = to_point.dot(entrance.normal) / distance;
  const double behind = route == 0 ? (optics->pupil.entrance().z - front_z(*this)) / kMmPerM : 0;
  if (!(cos_theta > 0 && distance * cos_theta > behind)) return std::nullopt;
  const double from_disc = behind / cos_theta;  // from the disc to the lens point, along the ray
  const V3f lens_point(entrance.point + to_point / distance * from_disc);
  const double farther = distance / (distance - from_disc);
  const auto lanes = trace_to_film(
      *this, grid, {ray_at(lens_point, V3f(to_point / distance), sample.time), sample.wavelengths_nm}, route);
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
  const auto [route, u] =
      draw_ghost(*optics, static_cast<double>(lens.x) * LensOptics::kGhostProbability, lens.y);
  const EntrancePoint at = draw_entrance(*this, u, route);
  return GhostEntrance{V3f(at.point), V3f(at.normal), route,
                       static_cast<float>(at.pdf / LensOptics::kGhostProbability)};
}

std::optional<CameraDensity> LensSystem::density(const FilmGrid& grid, const Ray& ray,
                                                 const SampledSpectrum& wavelengths_nm,
                                                 LensRoute route) const {
  const EntrancePoint entrance = entrance_at(*this, V3d(ray.origin), route);
  const double cos_theta = V3d(ray.direction).dot(entrance.normal);
  if (!(cos_theta > 0)) return std::nullopt;
  const auto lanes = trace_to_film(*this, grid, {ray, wavelengths_nm}, route);
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

double LensSystem::min_film_cosine(const FilmGrid& /*grid*/) const {
  return optics->least_cosine;
}

V3d LensSystem::center() const {
  return on_axis(*this, front_z(*this));
}

// The opening includes the first surface if there are ghosts.
CameraTraits LensSystem::traits() const {
  const bool numbered = optics->speed && std::isfinite(optics->speed->f_number);
  const auto in_m = [](const std::optional<double>& mm) {
    return mm ? std::optional(*mm / kMmPerM) : std::nullopt;
  };
  const double radius = std::max(front_radius(*this), ghosts ? optics->semi_aperture_mm(0) : 0.0) / kMmPerM;
  return {.depth_of_field = true,
          .displaces_wavelengths = true,
          .ghosts = ghosts,
          .polarises = true,
          .image_distance = in_m(optics->image_distance_mm),
          .pinhole_distance = in_m(optics->pinhole_distance_mm),
          .f_number = numbered ? std::optional(optics->speed->f_number) : std::nullopt,
          .axis = frame.forward,
          .opening = FlatOpening{center(), frame.right * radius, frame.up * radius, frame.forward, true}};
}

}  // namespace abbe
