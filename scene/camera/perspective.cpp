#include "scene/camera/perspective.h"

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

}  // namespace abbe
