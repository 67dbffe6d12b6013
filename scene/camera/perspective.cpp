#include "scene/camera/perspective.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "materials/bsdf/warp.h"

namespace abbe {
namespace {

// Points on film and lens are in metres along right and up. Tangents of directions are per unit of depth.
using Imath::V2d;
using Imath::V3d;

// Cosine between the axis and the direction with that tangent.
double cosine(const V2d& tangent) {
  return 1 / std::sqrt(1 + tangent.dot(tangent));
}

// Tangent of the direction from the lens center to a corner of the film.
double corner_tangent(const FilmGrid& grid, double image_distance) {
  return std::hypot(grid.width, grid.height) / 2 * grid.pixel_pitch / image_distance;
}

// Lowers a cosine computed in double by the rounding of cosines stored as floats.
double below_rounding(double cosine) {
  constexpr double kRounding = 1e-6;
  return cosine * (1 - kRounding);
}

V3d in_plane(const CameraFrame& frame, const V2d& p) {
  return frame.right * p.x + frame.up * p.y;
}

// Components of a vector along right, up and `forward`.
struct CameraVector {
  V2d across;
  double depth;
};
CameraVector components(const CameraFrame& frame, const V3d& d) {
  return {{d.dot(frame.right), d.dot(frame.up)}, d.dot(frame.forward)};
}
CameraVector to_camera_space(const CameraFrame& frame, const Imath::V3f& point) {
  return components(frame, V3d(point) - frame.position);
}

// Light passes a pinhole without deviation, at its center.
V2d lens_plane(const Pinhole& /*camera*/, Imath::V2f /*lens*/) {
  return {0, 0};
}
V2d lens_point(const Pinhole& /*camera*/, const Imath::V3f& /*origin*/) {
  return {0, 0};
}
double pdf_on_lens(const Pinhole& /*camera*/) {
  return 1;
}
double open_area(const Pinhole& camera) {
  return std::numbers::pi * camera.aperture_radius * camera.aperture_radius * camera.transmittance;
}
V2d tangent_from(const Pinhole& camera, const V2d& film, const V2d& /*lens*/) {
  return film / camera.image_distance;
}
V2d film_from(const Pinhole& camera, const V2d& tangent, const V2d& /*lens*/) {
  return tangent * camera.image_distance;
}
double film_cosine(const Pinhole& /*camera*/, const V2d& /*film*/, const V2d& /*lens*/, const V2d& tangent) {
  return cosine(tangent);
}

V2d lens_plane(const ThinLens& camera, Imath::V2f lens) {
  const V2d disc(concentric_disc(lens));
  return (camera.iris ? camera.iris->point(disc) : disc) * camera.aperture_radius;
}
V2d lens_point(const ThinLens& camera, const Imath::V3f& origin) {
  return to_camera_space(camera.frame, origin).across;
}
// Density of `lens_plane` [1/m^2].
double pdf_on_lens(const ThinLens& camera) {
  return 1 / (std::numbers::pi * camera.aperture_radius * camera.aperture_radius * camera.open_fraction());
}
// Area [m^2] of the lossless opening that gives the same exposure.
double open_area(const ThinLens& camera) {
  return std::numbers::pi * camera.aperture_radius * camera.aperture_radius * camera.transmittance *
         camera.open_fraction();
}
// Tangent of the scene ray through a lens point. It points to the in-focus point that the ray through the
// lens center hits. `film_from` is the inverse: the film point of that central ray.
V2d tangent_from(const ThinLens& camera, const V2d& film, const V2d& lens) {
  return film / camera.image_distance - lens / camera.focus_distance;
}
V2d film_from(const ThinLens& camera, const V2d& tangent, const V2d& lens) {
  return (tangent + lens / camera.focus_distance) * camera.image_distance;
}
// Cosine of the angle of incidence on the film. A sharp image of magnification m = v/s determines the
// direction cosines p' at the film: p' = p0 - (p - p0)/m. The ray in the scene has p, and the undeviated ray
// through the lens center has p0. On the axis this is Abbe's sine condition [Born1999, sec. 4.5]. The film
// point x and the lens point l give the tangents t0 = x/v and t = t0 - l/s, with the cosines c0 and c. Then
// -s (p - p0) = c (l - t0 c0 (t + t0).l/(1/c + 1/c0)), which is finite for s = infinity too.
double film_cosine(const ThinLens& camera, const V2d& film, const V2d& lens, const V2d& tangent) {
  const V2d center = film / camera.image_distance;
  const double c = cosine(tangent);
  const double c0 = cosine(center);
  const V2d deflection = (lens - center * (c0 * (tangent + center).dot(lens) / (1 / c + 1 / c0))) * c;
  const V2d sines = center * c0 + deflection / camera.image_distance;
  return std::sqrt(std::max(0.0, 1 - sines.dot(sines)));
}

// The camera ray through a lens point, with the weight open_area cos^4/v^2 [sr]. A film element dA sees
// through a lens element the solid angle dA cos^3/v^2 of the scene, v being the image distance. The lens
// element's projected area is proportional to cos. This gives the cos^4 law, with the angle on the scene
// side.
template <typename Camera>
CameraRay ray_of(const Camera& camera, const FilmGrid& grid, const CameraSample& sample) {
  const V2d on_film = film_plane(grid, sample.film);
  const V2d on_lens = lens_plane(camera, sample.lens);
  const V2d tangent = tangent_from(camera, on_film, on_lens);
  const double cos_theta = cosine(tangent);
  const double v = camera.image_distance;
  const double weight = open_area(camera) * cos_theta * cos_theta * cos_theta * cos_theta / (v * v);
  const V3d direction = (camera.frame.forward + in_plane(camera.frame, tangent)) * cos_theta;
  const Imath::V3f from(camera.frame.position + in_plane(camera.frame, on_lens));
  return {ray_at(from, Imath::V3f(direction), sample.time), SampledSpectrum(static_cast<float>(weight)),
          static_cast<float>(film_cosine(camera, on_film, on_lens, tangent))};
}

// The connection of a scene point, with the weight open_area cos/(d^2 p^2), where d is the distance and p the
// pixel pitch.
template <typename Camera>
std::optional<CameraConnection> connection_of(const Camera& camera, const FilmGrid& grid,
                                              const Imath::V3f& point, const CameraSample& sample) {
  const CameraVector local = to_camera_space(camera.frame, point);
  if (!(local.depth > 0)) return std::nullopt;
  const V2d on_lens = lens_plane(camera, sample.lens);
  const V2d tangent = (local.across - on_lens) / local.depth;
  const V2d on_film = film_from(camera, tangent, on_lens);
  const std::optional<Imath::V2f> film = film_position(grid, on_film);
  if (!film) return std::nullopt;
  const double cos_theta = cosine(tangent);
  const double distance = local.depth / cos_theta;
  const double pitch = grid.pixel_pitch;
  const double weight = open_area(camera) * cos_theta / (distance * distance * pitch * pitch);
  return CameraConnection{*film, Imath::V3f(camera.frame.position + in_plane(camera.frame, on_lens)),
                          static_cast<float>(pdf_on_lens(camera)),
                          SampledSpectrum(static_cast<float>(weight)),
                          static_cast<float>(film_cosine(camera, on_film, on_lens, tangent))};
}

// The density of a ray. A pixel of area p^2 has the density v^2/(p^2 cos^3) in directions. It receives the
// whole flux along the ray, divided by its area.
template <typename Camera>
std::optional<CameraDensity> density_of(const Camera& camera, const FilmGrid& grid, const Ray& ray) {
  const CameraVector direction = components(camera.frame, V3d(ray.direction));
  if (!(direction.depth > 0)) return std::nullopt;
  const V2d tangent = direction.across / direction.depth;
  const V2d on_lens = lens_point(camera, ray.origin);
  const V2d on_film = film_from(camera, tangent, on_lens);
  const std::optional<Imath::V2f> film = film_position(grid, on_film);
  if (!film) return std::nullopt;
  const double pixel_area = grid.pixel_pitch * grid.pixel_pitch;
  const double cos_theta = cosine(tangent);
  const double v = camera.image_distance;
  const double pdf_position = pdf_on_lens(camera);
  const double pdf_direction = v * v / (pixel_area * cos_theta * cos_theta * cos_theta);
  return CameraDensity{*film,
                       SampledSpectrum(static_cast<float>(open_area(camera) * pdf_position / pixel_area)),
                       static_cast<float>(pdf_position),
                       SampledSpectrum(static_cast<float>(pdf_direction)),
                       static_cast<float>(cos_theta),
                       static_cast<float>(film_cosine(camera, on_film, on_lens, tangent))};
}

}  // namespace

std::optional<Imath::V2f> film_position(const FilmGrid& grid, const V2d& point) {
  const double pitch = grid.pixel_pitch;
  const Imath::V2f film(static_cast<float>(point.x / pitch + grid.width * 0.5),
                        static_cast<float>(grid.height * 0.5 - point.y / pitch));
  if (!(film.x >= 0 && film.x < static_cast<float>(grid.width) && film.y >= 0 &&
        film.y < static_cast<float>(grid.height)))
    return std::nullopt;
  return film;
}

CameraRay Pinhole::sample_ray(const FilmGrid& grid, const CameraSample& sample) const {
  return ray_of(*this, grid, sample);
}

std::optional<CameraConnection> Pinhole::sample_towards(const FilmGrid& grid, const Imath::V3f& point,
                                                        const CameraSample& sample) const {
  return connection_of(*this, grid, point, sample);
}

std::optional<CameraDensity> Pinhole::density(const FilmGrid& grid, const Ray& ray,
                                              const SampledSpectrum& /*wavelengths_nm*/,
                                              LensRoute /*route*/) const {
  return density_of(*this, grid, ray);
}

double Pinhole::min_film_cosine(const FilmGrid& grid) const {
  return below_rounding(cosine({corner_tangent(grid, image_distance), 0}));
}

CameraTraits Pinhole::traits() const {
  return {.image_distance = image_distance,
          .f_number = image_distance / (2 * aperture_radius),
          .axis = frame.forward};
}

CameraRay ThinLens::sample_ray(const FilmGrid& grid, const CameraSample& sample) const {
  return ray_of(*this, grid, sample);
}

std::optional<CameraConnection> ThinLens::sample_towards(const FilmGrid& grid, const Imath::V3f& point,
                                                         const CameraSample& sample) const {
  return connection_of(*this, grid, point, sample);
}

std::optional<CameraDensity> ThinLens::density(const FilmGrid& grid, const Ray& ray,
                                               const SampledSpectrum& /*wavelengths_nm*/,
                                               LensRoute /*route*/) const {
  return density_of(*this, grid, ray);
}

double ThinLens::min_film_cosine(const FilmGrid& grid) const {
  const double tangent = corner_tangent(grid, image_distance);
  const double sine = tangent * cosine({tangent, 0}) + aperture_radius / image_distance;
  return below_rounding(std::sqrt(std::max(0.0, (1 - sine) * (1 + sine))));
}

CameraTraits ThinLens::traits() const {
  const double focal_length = 1 / (1 / image_distance + 1 / focus_distance);
  return {.depth_of_field = true,
          .image_distance = image_distance,
          .f_number = focal_length / (2 * aperture_radius),
          .axis = frame.forward,
          .opening = FlatOpening{frame.position, frame.right * aperture_radius, frame.up * aperture_radius,
                                 frame.forward, true, iris}};
}

}  // namespace abbe
