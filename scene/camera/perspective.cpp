#include "scene/camera/perspective.h"

#include <algorithm>
#include <cmath>

#include "materials/bsdf/warp.h"

namespace abbe {

namespace {

Imath::V3d in_scene(const CameraFrame& frame, const PlanePoint& p) {
  return frame.right * p.x + frame.up * p.y;
}

}  // namespace

std::optional<Imath::V2f> film_position(const FilmGrid& grid, const PlanePoint& point) {
  const double pitch = grid.pixel_pitch;
  const Imath::V2f film(static_cast<float>(point.x / pitch + grid.width * 0.5),
                        static_cast<float>(grid.height * 0.5 - point.y / pitch));
  if (!(film.x >= 0 && film.x < static_cast<float>(grid.width) && film.y >= 0 &&
        film.y < static_cast<float>(grid.height)))
    return std::nullopt;
  return film;
}

double corner_tangent(const FilmGrid& grid, double image_distance) {
  return std::hypot(grid.width, grid.height) / 2 * grid.pixel_pitch / image_distance;
}

CameraRay ray_through(const Perspective& view, const LensCrossing& at, float time) {
  const double cos_theta = at.cos_theta;
  const double v = view.image_distance;
  const double weight = view.exposing_area * cos_theta * cos_theta * cos_theta * cos_theta / (v * v);
  const Imath::V3d direction = (view.frame.forward + in_scene(view.frame, at.tangent)) * cos_theta;
  const Imath::V3f on_lens(view.frame.position + in_scene(view.frame, at.on_lens));
  return {ray_at(on_lens, Imath::V3f(direction), time), SampledSpectrum(static_cast<float>(weight)),
          static_cast<float>(at.cos_film)};
}

CameraPoint to_camera_space(const CameraFrame& frame, const Imath::V3f& point) {
  const Imath::V3d d = Imath::V3d(point) - frame.position;
  return {{d.dot(frame.right), d.dot(frame.up)}, d.dot(frame.forward)};
}

CameraConnection connection_through(const Perspective& view, const FilmGrid& grid, Imath::V2f film,
                                    const LensCrossing& at, double depth, double pdf_position) {
  const double cos_theta = at.cos_theta;
  const double distance = depth / cos_theta;
  const double pitch = grid.pixel_pitch;
  const double weight = view.exposing_area * cos_theta / (distance * distance * pitch * pitch);
  return {film, Imath::V3f(view.frame.position + in_scene(view.frame, at.on_lens)),
          static_cast<float>(pdf_position), SampledSpectrum(static_cast<float>(weight)),
          static_cast<float>(at.cos_film)};
}

std::optional<PlanePoint> tangent_of(const CameraFrame& frame, const Imath::V3f& direction) {
  const Imath::V3d d(direction);
  const double along = d.dot(frame.forward);
  if (!(along > 0)) return std::nullopt;
  return PlanePoint(d.dot(frame.right), d.dot(frame.up)) / along;
}

CameraDensity density_through(const Perspective& view, const FilmGrid& grid, Imath::V2f film,
                              const LensCrossing& at, double pdf_position) {
  const double pixel_area = grid.pixel_pitch * grid.pixel_pitch;
  const double cos_theta = at.cos_theta;
  const double v = view.image_distance;
  const double pdf_direction = v * v / (pixel_area * cos_theta * cos_theta * cos_theta);
  return {film,
          SampledSpectrum(static_cast<float>(view.exposing_area * pdf_position / pixel_area)),
          static_cast<float>(pdf_position),
          SampledSpectrum(static_cast<float>(pdf_direction)),
          static_cast<float>(cos_theta),
          static_cast<float>(at.cos_film)};
}

namespace {

Perspective view_of(const Pinhole& camera) {
  return {camera.frame, camera.image_distance, exposing_area(camera.aperture_radius, camera.transmittance)};
}

// Light passes a pinhole without deviation.
LensCrossing crossing(const PlanePoint& tangent) {
  const double cos_theta = cosine(tangent);
  return {{0, 0}, tangent, cos_theta, cos_theta};
}

}  // namespace

CameraRay Pinhole::sample_ray(const FilmGrid& grid, Imath::V2f film, Imath::V2f /*lens*/,
                              const SampledSpectrum& /*wavelengths_nm*/, int /*hero*/, float time) const {
  return ray_through(view_of(*this), crossing(film_plane(grid, film) / image_distance), time);
}

std::optional<CameraConnection> Pinhole::sample_towards(const FilmGrid& grid, const Imath::V3f& point,
                                                        Imath::V2f /*lens*/,
                                                        const SampledSpectrum& /*wavelengths_nm*/,
                                                        float /*time*/) const {
  const CameraPoint local = to_camera_space(frame, point);
  if (!(local.depth > 0)) return std::nullopt;
  const PlanePoint tangent = local.across / local.depth;
  const std::optional<Imath::V2f> film = film_position(grid, tangent * image_distance);
  if (!film) return std::nullopt;
  return connection_through(view_of(*this), grid, *film, crossing(tangent), local.depth, 1);
}

std::optional<CameraDensity> Pinhole::density(const FilmGrid& grid, const Ray& ray,
                                              const SampledSpectrum& /*wavelengths_nm*/,
                                              LensRoute /*route*/) const {
  const std::optional<PlanePoint> tangent = tangent_of(frame, ray.direction);
  if (!tangent) return std::nullopt;
  const std::optional<Imath::V2f> film = film_position(grid, *tangent * image_distance);
  if (!film) return std::nullopt;
  return density_through(view_of(*this), grid, *film, crossing(*tangent), 1);
}

double Pinhole::min_film_cosine(const FilmGrid& grid) const {
  return below_rounding(cosine(PlanePoint(corner_tangent(grid, image_distance), 0)));
}

CameraTraits Pinhole::traits() const {
  return {.image_distance = image_distance,
          .f_number = image_distance / (2 * aperture_radius),
          .axis = frame.forward};
}

namespace {

Perspective view_of(const ThinLens& camera) {
  return {camera.frame, camera.image_distance,
          exposing_area(camera.aperture_radius, camera.transmittance) * camera.open_fraction()};
}

PlanePoint lens_plane(const ThinLens& camera, Imath::V2f lens) {
  const PlanePoint disc(concentric_disc(lens));
  return (camera.iris ? camera.iris->point(disc) : disc) * camera.aperture_radius;
}

double pdf_on_lens(const ThinLens& camera) {
  return 1 / (exposing_area(camera.aperture_radius, 1) * camera.open_fraction());
}

// Tangent of the scene ray through a lens point. It points to the in-focus point that the ray through the
// lens center hits. `film_from` is the inverse: the film point of that central ray.
PlanePoint tangent_from(const ThinLens& camera, const PlanePoint& film, const PlanePoint& lens) {
  return film / camera.image_distance - lens / camera.focus_distance;
}
PlanePoint film_from(const ThinLens& camera, const PlanePoint& tangent, const PlanePoint& lens) {
  return (tangent + lens / camera.focus_distance) * camera.image_distance;
}

// Cosine of the angle of incidence on the film. A sharp image of magnification m = v/s determines the
// direction cosines p' at the film: p' = p0 - (p - p0)/m. The ray in the scene has p, and the undeviated ray
// through the lens center has p0. On the axis this is Abbe's sine condition [Born1999, sec. 4.5]. The film
// point x and the lens point l give the tangents t0 = x/v and t = t0 - l/s, with the cosines c0 and c. Then
// -s (p - p0) = c (l - t0 c0 (t + t0).l/(1/c + 1/c0)), which is finite for s = infinity too.
double film_cosine(const ThinLens& camera, const PlanePoint& film, const PlanePoint& lens,
                   const PlanePoint& tangent) {
  const PlanePoint center = film / camera.image_distance;
  const double c = cosine(tangent);
  const double c0 = cosine(center);
  const PlanePoint deflection = (lens - center * (c0 * (tangent + center).dot(lens) / (1 / c + 1 / c0))) * c;
  const PlanePoint sines = center * c0 + deflection / camera.image_distance;
  return std::sqrt(std::max(0.0, 1 - sines.dot(sines)));
}

LensCrossing crossing(const ThinLens& camera, const PlanePoint& film, const PlanePoint& lens,
                      const PlanePoint& tangent) {
  return {lens, tangent, cosine(tangent), film_cosine(camera, film, lens, tangent)};
}

}  // namespace

CameraRay ThinLens::sample_ray(const FilmGrid& grid, Imath::V2f film, Imath::V2f lens,
                               const SampledSpectrum& /*wavelengths_nm*/, int /*hero*/, float time) const {
  const PlanePoint on_film = film_plane(grid, film);
  const PlanePoint on_lens = lens_plane(*this, lens);
  return ray_through(view_of(*this), crossing(*this, on_film, on_lens, tangent_from(*this, on_film, on_lens)),
                     time);
}

std::optional<CameraConnection> ThinLens::sample_towards(const FilmGrid& grid, const Imath::V3f& point,
                                                         Imath::V2f lens,
                                                         const SampledSpectrum& /*wavelengths_nm*/,
                                                         float /*time*/) const {
  const CameraPoint local = to_camera_space(frame, point);
  if (!(local.depth > 0)) return std::nullopt;
  const PlanePoint on_lens = lens_plane(*this, lens);
  const PlanePoint tangent = (local.across - on_lens) / local.depth;
  const PlanePoint on_film = film_from(*this, tangent, on_lens);
  const std::optional<Imath::V2f> film = film_position(grid, on_film);
  if (!film) return std::nullopt;
  return connection_through(view_of(*this), grid, *film, crossing(*this, on_film, on_lens, tangent),
                            local.depth, pdf_on_lens(*this));
}

std::optional<CameraDensity> ThinLens::density(const FilmGrid& grid, const Ray& ray,
                                               const SampledSpectrum& /*wavelengths_nm*/,
                                               LensRoute /*route*/) const {
  const std::optional<PlanePoint> tangent = tangent_of(frame, ray.direction);
  if (!tangent) return std::nullopt;
  const PlanePoint on_lens = to_camera_space(frame, ray.origin).across;
  const PlanePoint on_film = film_from(*this, *tangent, on_lens);
  const std::optional<Imath::V2f> film = film_position(grid, on_film);
  if (!film) return std::nullopt;
  return density_through(view_of(*this), grid, *film, crossing(*this, on_film, on_lens, *tangent),
                         pdf_on_lens(*this));
}

double ThinLens::min_film_cosine(const FilmGrid& grid) const {
  const double tangent = corner_tangent(grid, image_distance);
  const double sine = tangent * cosine(PlanePoint(tangent, 0)) + aperture_radius / image_distance;
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
