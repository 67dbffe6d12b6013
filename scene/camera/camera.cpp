#include "scene/camera/camera.h"

#include <cmath>
#include <numbers>

#include "materials/bsdf/warp.h"
#include "scene/shapes/basis.h"

namespace abbe {
namespace {

// Coordinates along right and up: on the film as it is seen through the centre of the lens, upright, or on
// the lens.
using Plane = Imath::V2d;

Imath::V3d in_scene(const CameraFrame& frame, const Plane& p) {
  return frame.right * p.x + frame.up * p.y;
}

Plane film_plane(const Camera& camera, Imath::V2f film) {
  return {(static_cast<double>(film.x) - camera.width * 0.5) * camera.pixel_pitch,
          (camera.height * 0.5 - static_cast<double>(film.y)) * camera.pixel_pitch};
}

Plane lens_plane(const LensCamera& camera, Imath::V2f lens) {
  return camera.pinhole ? Plane(0, 0) : Plane(concentric_disc(lens)) * camera.aperture_radius;
}

// Tangent vector in the lens plane per unit of depth, of the scene ray through a lens point that is imaged on
// a film point: it aims at the point in focus, which the ray through the centre of the lens shows.
Plane slope(const LensCamera& camera, const Plane& film, const Plane& lens) {
  const Plane through_center = film / camera.image_distance;
  return camera.pinhole ? through_center : through_center - lens / camera.focus_distance;
}

double cosine(const Plane& slope) {
  return 1 / std::sqrt(1 + slope.dot(slope));
}

// The real image is upside down, so a ray in the camera runs from -film to the lens. Through a pinhole it
// goes straight on, at the angle whose cosine is `cos_theta`.
float film_cosine(const LensCamera& camera, const Plane& film, const Plane& lens, double cos_theta) {
  return static_cast<float>(camera.pinhole ? cos_theta : cosine((film + lens) / camera.image_distance));
}

// Of an opening that passes all light and exposes as much.
double aperture_area(const LensCamera& camera) {
  return std::numbers::pi * camera.aperture_radius * camera.aperture_radius * camera.transmittance;
}

// A film element dA sees through the lens element the solid angle dA cos^3/v^2 of the scene, v the image
// distance; the lens element presents a share cos of its area. Hence the cos^4 law, with the angle on the
// side of the scene.
CameraRay lens_ray(const Camera& camera, const LensCamera& lens_camera, Imath::V2f film, Imath::V2f lens) {
  const CameraFrame& frame = lens_camera.frame;
  const Plane on_film = film_plane(camera, film);
  const Plane on_lens = lens_plane(lens_camera, lens);
  const Plane tangent = slope(lens_camera, on_film, on_lens);
  const double cos_theta = cosine(tangent);
  const double v = lens_camera.image_distance;
  const double weight = aperture_area(lens_camera) * cos_theta * cos_theta * cos_theta * cos_theta / (v * v);
  const Imath::V3d direction = (frame.forward + in_scene(frame, tangent)) * cos_theta;
  return {{Imath::V3f(frame.position + in_scene(frame, on_lens)), Imath::V3f(direction)},
          static_cast<float>(weight),
          film_cosine(lens_camera, on_film, on_lens, cos_theta)};
}

CameraRay probe_ray(const Camera& camera, const IrradianceProbe& probe, Imath::V2f film, Imath::V2f lens) {
  const Imath::V3d point = probe.corner + probe.edge_u * (static_cast<double>(film.x) / camera.width) +
                           probe.edge_v * (static_cast<double>(film.y) / camera.height);
  const Imath::V3f local = cosine_hemisphere(lens);
  const Imath::V3f normal(probe.normal);
  const Imath::V3f direction = Basis<float>(normal).to_world(local);
  return {{offset_point(Imath::V3f(point), normal, normal), direction}, std::numbers::pi_v<float>, local.z};
}

}  // namespace

const Imath::V3d& position(const Camera& camera) {
  if (const auto* lens = std::get_if<LensCamera>(&camera.kind)) return lens->frame.position;
  return std::get<IrradianceProbe>(camera.kind).corner;
}

Imath::V3d& position(Camera& camera) {
  if (auto* lens = std::get_if<LensCamera>(&camera.kind)) return lens->frame.position;
  return std::get<IrradianceProbe>(camera.kind).corner;
}

Imath::V3d middle(const Camera& camera) {
  const auto* probe = std::get_if<IrradianceProbe>(&camera.kind);
  return probe == nullptr ? position(camera) : probe->corner + (probe->edge_u + probe->edge_v) * 0.5;
}

CameraRay sample_ray(const Camera& camera, Imath::V2f film, Imath::V2f lens) {
  if (const auto* probe = std::get_if<IrradianceProbe>(&camera.kind))
    return probe_ray(camera, *probe, film, lens);
  return lens_ray(camera, std::get<LensCamera>(camera.kind), film, lens);
}

double least_film_cosine(const Camera& camera) {
  const auto* lens = std::get_if<LensCamera>(&camera.kind);
  if (lens == nullptr) return 0;
  constexpr double kRounding = 1e-6;  // of cosines kept as floats
  const double corner = std::hypot(camera.width, camera.height) / 2 * camera.pixel_pitch;
  const double opening = lens->pinhole ? 0 : lens->aperture_radius;
  return cosine(Plane((corner + opening) / lens->image_distance, 0)) * (1 - kRounding);
}

std::optional<CameraConnection> sample_towards(const Camera& camera, const Imath::V3f& point,
                                               Imath::V2f lens) {
  const auto* lens_camera = std::get_if<LensCamera>(&camera.kind);
  if (lens_camera == nullptr) return std::nullopt;
  const CameraFrame& frame = lens_camera->frame;
  const Imath::V3d from_center = Imath::V3d(point) - frame.position;
  const double depth = from_center.dot(frame.forward);
  if (!(depth > 0)) return std::nullopt;
  const Plane on_lens = lens_plane(*lens_camera, lens);
  const Plane tangent = (Plane(from_center.dot(frame.right), from_center.dot(frame.up)) - on_lens) / depth;
  const Plane offset = lens_camera->pinhole ? Plane(0, 0) : on_lens / lens_camera->focus_distance;
  const Plane on_film = (tangent + offset) * lens_camera->image_distance;  // the inverse of `slope`
  const double pitch = camera.pixel_pitch;
  const Imath::V2f film(static_cast<float>(on_film.x / pitch + camera.width * 0.5),
                        static_cast<float>(camera.height * 0.5 - on_film.y / pitch));
  if (!(film.x >= 0 && film.x < static_cast<float>(camera.width) && film.y >= 0 &&
        film.y < static_cast<float>(camera.height)))
    return std::nullopt;
  const double cos_theta = cosine(tangent);
  const double distance = depth / cos_theta;
  const double weight = aperture_area(*lens_camera) * cos_theta / (distance * distance * pitch * pitch);
  return CameraConnection{film, Imath::V3f(frame.position + in_scene(frame, on_lens)),
                          static_cast<float>(weight), film_cosine(*lens_camera, on_film, on_lens, cos_theta)};
}

}  // namespace abbe
