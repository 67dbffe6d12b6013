#include "scene/camera/lens_system.h"

#include <cmath>
#include <numbers>

#include "lens/paraxial.h"
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

constexpr double kMmPerM = 1000;

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

double entrance_area(const LensOptics& optics) {
  const double radius = optics.pupil.entrance().radius / kMmPerM;
  return std::numbers::pi * radius * radius;
}
V3d entrance_center(const LensSystem& camera) {
  return camera.frame.position - camera.frame.forward * (camera.optics->pupil.entrance().z / kMmPerM);
}

// A lane of a ray where it comes to the film.
struct Landing {
  V2f film;
  double cos_film;
  double transmittance;
  double pdf;  // a p_j [1/sr]
};

// Nothing for a lane that does not get to the film, or not through the bound of its exit pupil.
std::optional<Landing> landing(const LensOptics& optics, const FilmGrid& grid,
                               const lens::BasicArrival<lens::Doubles>& arrival, int lane) {
  if (!arrival.arrived[lane]) return std::nullopt;
  const V2d point(arrival.point.x[lane], arrival.point.y[lane]);
  const auto film = film_position(grid, -point / kMmPerM);
  if (!film) return std::nullopt;
  const double depth = optics.system.image_z() - optics.system.last_z();
  const V3d d(arrival.direction.x[lane], arrival.direction.y[lane], arrival.direction.z[lane]);
  const lens::PupilBound bound = optics.pupil.bound(point);
  if (!bound.contains(point - V2d(d.x, d.y) * (depth / d.z))) return std::nullopt;
  const double cos2 = d.z * d.z;
  return Landing{*film, d.z, arrival.transmittance[lane], depth * depth / (bound.area() * cos2 * cos2)};
}

// All lanes of a ray.
struct Landings {
  LaneImages images;
  SampledSpectrum transmittance;
  SampledSpectrum pdf;
};

// Light comes along the ray against its direction. Nothing where no lane comes to the film.
std::optional<Landings> land(const LensSystem& camera, const FilmGrid& grid, const Ray& ray,
                             const SampledSpectrum& wavelengths_nm) {
  const lens::Ray of_lens{in_lens(camera.frame, V3d(ray.origin) - camera.frame.position) * kMmPerM,
                          -in_lens(camera.frame, V3d(ray.direction)).normalized()};
  const auto arrival = camera.optics->system.to_image(of_lens, wavelengths_nm);
  std::array<std::optional<Landing>, kLanes> lanes;
  const Landing* any = nullptr;
  for (std::size_t j = 0; j < kLanes; ++j) {
    lanes[j] = landing(*camera.optics, grid, arrival, static_cast<int>(j));
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
  return Landings{{SampledSpectrum(of[0]), SampledSpectrum(of[1]), SampledSpectrum(of[2])},
                  SampledSpectrum(of[3]),
                  SampledSpectrum(of[4])};
}

// The ray in the scene of one from a film point to a point of the bound of its exit pupil.
std::optional<Ray> scene_ray(const LensSystem& camera, const V2d& image, const V2d& pupil,
                             double wavelength_nm, float time) {
  const LensOptics& optics = *camera.optics;
  const V3d from(image.x, image.y, optics.system.image_z());
  const V3d to(pupil.x, pupil.y, optics.system.last_z());
  const auto out = optics.system.to_object({from, (to - from).normalized()}, wavelength_nm);
  if (!out) return std::nullopt;
  const V3d& d = out->direction;
  const V3d start = out->origin + (optics.pupil.entrance().z - out->origin.z) / d.z * d;
  return ray_at(V3f(camera.frame.position + lens_in_scene(camera.frame, start) / kMmPerM),
                V3f(lens_in_scene(camera.frame, d)), time);
}

}  // namespace

LensOptics::LensOptics(lens::System lens, double stop_radius_mm, const FilmGrid& grid, double low_nm,
                       double high_nm)
    : system(std::move(lens), stop_radius_mm),
      pupil(system, V2d(grid.width, grid.height) * (grid.pixel_pitch * kMmPerM / 2), low_nm, high_nm) {
  const lens::System& of = system.system();
  constexpr int kSpeedCells = 64;  // across the axial beam
  const lens::SystemAt at(of, of.primary_nm());
  image_distance_mm = std::abs(of.surfaces.back().thickness_mm - lens::first_order(at).rear_principal_mm);
  speed = lens::speed(at, stop_radius_mm, kSpeedCells);
}

// Where the lens lets nothing through, the ray is that of the middle of the pupil, and weighs nothing.
CameraRay LensSystem::sample_ray(const FilmGrid& grid, V2f film, V2f lens,
                                 const SampledSpectrum& wavelengths_nm, int hero, float time) const {
  const auto nm = static_cast<double>(wavelengths_nm[hero]);
  const V2d image = image_of_film(grid, film);
  const lens::PupilBound bound = optics->pupil.bound(image);
  const V2d disc(concentric_disc(lens));
  const auto ray = scene_ray(*this, image, bound.point(disc), nm, time);
  const auto lanes = ray ? land(*this, grid, *ray, wavelengths_nm) : std::nullopt;
  if (!lanes || !(lanes->pdf[hero] > 0)) {
    const auto middle_ray = scene_ray(*this, image, bound.point({0, 0}), nm, time);
    return {middle_ray.value_or(ray_at(V3f(middle()), V3f(frame.forward), time)), SampledSpectrum(), 1};
  }
  const SampledSpectrum drawn(lanes->pdf[hero]);
  return {*ray, lanes->transmittance / drawn, lanes->images.cos_film[hero], lanes->pdf / drawn,
          lanes->images};
}

std::optional<CameraConnection> LensSystem::sample_towards(const FilmGrid& grid, const V3f& point, V2f lens,
                                                           const SampledSpectrum& wavelengths_nm,
                                                           float time) const {
  const lens::EntranceDisc& disc = optics->pupil.entrance();
  const V2d on_disc = V2d(concentric_disc(lens)) * (disc.radius / kMmPerM);
  const V3f lens_point(entrance_center(*this) + frame.right * on_disc.x + frame.up * on_disc.y);
  const V3d way = V3d(point) - V3d(lens_point);
  const double distance = way.length();
  const double cos_theta = way.dot(frame.forward) / distance;
  if (!(cos_theta > 0)) return std::nullopt;
  const auto lanes = land(*this, grid, ray_at(lens_point, V3f(way / distance), time), wavelengths_nm);
  if (!lanes) return std::nullopt;
  const double weight =
      entrance_area(*optics) * cos_theta / (distance * distance * grid.pixel_pitch * grid.pixel_pitch);
  return CameraConnection{{lanes->images.x[0], lanes->images.y[0]},
                          lens_point,
                          lanes->transmittance * static_cast<float>(weight),
                          lanes->images.cos_film[0],
                          lanes->images};
}

std::optional<CameraDensity> LensSystem::density(const FilmGrid& grid, const Ray& ray,
                                                 const SampledSpectrum& wavelengths_nm) const {
  const double cos_theta = V3d(ray.direction).dot(frame.forward);
  if (!(cos_theta > 0)) return std::nullopt;
  const auto lanes = land(*this, grid, ray, wavelengths_nm);
  if (!lanes) return std::nullopt;
  const double pixel_area = grid.pixel_pitch * grid.pixel_pitch;
  const double disc_area = entrance_area(*optics);
  return CameraDensity{{lanes->images.x[0], lanes->images.y[0]},
                       lanes->transmittance * static_cast<float>(1 / pixel_area),
                       static_cast<float>(1 / disc_area),
                       lanes->pdf * static_cast<float>(cos_theta * disc_area / pixel_area),
                       static_cast<float>(cos_theta),
                       lanes->images.cos_film[0],
                       lanes->images};
}

double LensSystem::least_film_cosine(const FilmGrid& /*grid*/) const {
  return optics->pupil.least_cosine();
}

V3d LensSystem::middle() const {
  return entrance_center(*this);
}

CameraTraits LensSystem::traits() const {
  const double disc_radius = optics->pupil.entrance().radius / kMmPerM;
  return {.depth_of_field = true,
          .displaces_lanes = true,
          .image_distance = optics->image_distance_mm / kMmPerM,
          .f_number = optics->speed ? std::optional(optics->speed->f_number) : std::nullopt,
          .axis = frame.forward,
          .opening = Opening{entrance_center(*this), frame.right * disc_radius, frame.up * disc_radius,
                             frame.forward, true}};
}

}  // namespace abbe
