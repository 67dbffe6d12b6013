#include "scene/camera/pinhole.h"

#include "scene/camera/perspective.h"

namespace abbe {
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

}  // namespace abbe
