#include "scene/camera/thin_lens.h"

#include <algorithm>
#include <cmath>

#include "materials/bsdf/warp.h"
#include "scene/camera/perspective.h"

namespace abbe {
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
