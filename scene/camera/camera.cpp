#include "scene/camera/camera.h"

#include "scene/camera/camera_rays.h"

namespace abbe {
namespace {

Imath::V3f moved_point(const Imath::V3f& point, const Imath::M44d& by) {
  return Imath::V3f(Imath::V3d(point) * by);
}

Imath::V3d turned_direction(const Imath::V3d& direction, const Imath::M44d& by) {
  Imath::V3d moved;
  by.multDirMatrix(direction, moved);
  return moved;
}

Ray moved_ray(const Ray& ray, const Imath::M44d& by) {
  return {moved_point(ray.origin, by), Imath::V3f(turned_direction(Imath::V3d(ray.direction), by)), ray.t_max,
          ray.time};
}

void turn(std::optional<LaneImages>& images, const Imath::M44d& by) {
  if (images) images->jones.axis = Imath::V3f(turned_direction(Imath::V3d(images->jones.axis), by));
}

Imath::M44d motion_until(const Camera& camera, float time) {
  return camera.motion->since_opening(static_cast<double>(time));
}

void move(CameraRay& ray, const Camera& camera, float time) {
  const Imath::M44d since_opening = motion_until(camera, time);
  ray.ray = moved_ray(ray.ray, since_opening);
  turn(ray.images, since_opening);
}

// Where a ray that leaves the meter begins, whatever the meter lies on.
Imath::V3f off_meter(const Camera& meter, const Ray& ray) {
  const Imath::V3f at_rest = meter_normal(meter, seen_at_rest(meter, ray).origin);
  const Imath::V3f normal(direction_at(meter, Imath::V3d(at_rest), ray.time));
  return offset_point(ray.origin, normal, normal);
}

}  // namespace

CameraRay sample_ray(const Camera& camera, Imath::V2f film, Imath::V2f lens,
                     const SampledSpectrum& wavelengths_nm, int hero, float time) {
  CameraRay ray = std::visit(
      [&](const auto& kind) {
        return kind.sample_ray(camera.film(), film, lens, wavelengths_nm, hero, time);
      },
      camera.kind);
  if (camera.motion) move(ray, camera, time);
  return ray;
}

void sample_rays(const Camera& camera, std::span<const CameraSample> samples, std::span<CameraRay> rays) {
  const auto* lens = std::get_if<LensSystem>(&camera.kind);
  if (lens == nullptr) {
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const auto& [film, on_lens, wavelengths_nm, hero, time] = samples[i];
      rays[i] = sample_ray(camera, film, on_lens, wavelengths_nm, hero, time);
    }
    return;
  }
  sample_rays(*lens, camera.film(), samples, rays);
  if (camera.motion)
    for (std::size_t i = 0; i < samples.size(); ++i) move(rays[i], camera, samples[i].time);
}

std::optional<CameraConnection> sample_towards(const Camera& camera, const Imath::V3f& point, Imath::V2f lens,
                                               const SampledSpectrum& wavelengths_nm, float time) {
  const auto connect = [&](const Imath::V3f& seen) {
    return std::visit(
        [&](const auto& kind) {
          return kind.sample_towards(camera.film(), seen, lens, wavelengths_nm, time);
        },
        camera.kind);
  };
  if (!camera.motion) return connect(point);
  const Imath::M44d since_opening = motion_until(camera, time);
  std::optional<CameraConnection> found = connect(moved_point(point, rigid_inverse(since_opening)));
  if (!found) return found;
  found->lens_point = moved_point(found->lens_point, since_opening);
  turn(found->images, since_opening);
  return found;
}

std::optional<CameraDensity> density(const Camera& camera, const Ray& ray,
                                     const SampledSpectrum& wavelengths_nm, LensRoute route) {
  const Ray& seen = camera.motion ? seen_at_rest(camera, ray) : ray;
  std::optional<CameraDensity> of =
      std::visit([&](const auto& kind) { return kind.density(camera.film(), seen, wavelengths_nm, route); },
                 camera.kind);
  if (camera.motion && of) turn(of->images, motion_until(camera, ray.time));
  return of;
}

std::optional<CameraConnection> connection_through(const Camera& camera, const Opening& opening,
                                                   const Ray& light, const SampledSpectrum& wavelengths_nm) {
  const std::optional<double> distance = crossing(opening, seen_at_rest(camera, light));
  if (!distance) return std::nullopt;
  const Imath::V3f point(Imath::V3d(light.origin) + Imath::V3d(light.direction) * *distance);
  const Ray back = ray_at(point, -light.direction, light.time);
  const auto seen = density(camera, back, wavelengths_nm);
  if (!seen) return std::nullopt;
  return CameraConnection{seen->film,         is_meter(camera) ? off_meter(camera, back) : point,
                          seen->pdf_position, seen->importance,
                          seen->cos_film,     seen->images};
}

std::optional<GhostEntrance> sample_ghost(const Camera& camera, Imath::V2f lens, float time) {
  const auto* kind = std::get_if<LensSystem>(&camera.kind);
  auto found = kind != nullptr ? kind->sample_ghost(lens) : std::nullopt;
  if (!camera.motion || !found) return found;
  const Imath::M44d since_opening = motion_until(camera, time);
  found->point = moved_point(found->point, since_opening);
  found->normal = Imath::V3f(turned_direction(Imath::V3d(found->normal), since_opening));
  return found;
}

Camera without_ghosts(Camera camera) {
  if (auto* lens = std::get_if<LensSystem>(&camera.kind)) lens->ghosts = false;
  return camera;
}

Ray seen_at_rest(const Camera& camera, const Ray& ray) {
  return camera.motion ? moved_ray(ray, rigid_inverse(motion_until(camera, ray.time))) : ray;
}

Imath::V3d direction_at(const Camera& camera, const Imath::V3d& direction, float time) {
  return camera.motion ? turned_direction(direction, motion_until(camera, time)) : direction;
}

double least_film_cosine(const Camera& camera) {
  return std::visit([&](const auto& kind) { return kind.least_film_cosine(camera.film()); }, camera.kind);
}

CameraTraits traits(const Camera& camera) {
  return std::visit([](const auto& kind) { return kind.traits(); }, camera.kind);
}

const Imath::V3d& position(const Camera& camera) {
  return std::visit([](const auto& kind) -> const Imath::V3d& { return kind.position(); }, camera.kind);
}

Imath::V3d middle(const Camera& camera) {
  return std::visit([](const auto& kind) { return kind.middle(); }, camera.kind);
}

void translate(Camera& camera, const Imath::V3d& by) {
  std::visit([&](auto& kind) { kind.translate(by); }, camera.kind);
}

bool is_meter(const Camera& camera) {
  return std::holds_alternative<Probe>(camera.kind);
}

Imath::V3f meter_normal(const Camera& meter, const Imath::V3f& point) {
  return std::get<Probe>(meter.kind).normal_at(point);
}

Imath::Box3d bounds(const Camera& camera) {
  const Imath::V3d center = middle(camera);
  const std::optional<Opening> opening = traits(camera).opening;
  constexpr double kBeside = 1.01;  // where rays begin
  const double reach = opening ? kBeside * extent(*opening) : (center - position(camera)).length();
  Imath::Box3d box(center - Imath::V3d(reach), center + Imath::V3d(reach));
  if (!camera.motion) return box;
  const Imath::Box3d path = camera.motion->sweep({center}, 0, 1);
  return {path.min - Imath::V3d(reach), path.max + Imath::V3d(reach)};
}

Imath::V3f meter_point(const Camera& meter, Imath::V2f place) {
  const FilmGrid film = meter.film();
  const Imath::V2f at(place.x * static_cast<float>(film.width), place.y * static_cast<float>(film.height));
  return std::get<Probe>(meter.kind).sample_ray(film, at, {0.5F, 0.5F}, {}, 0, 0).ray.origin;
}

std::optional<Imath::V3f> film_right(const Camera& camera, float time) {
  const auto right = [&](const auto& kind) -> std::optional<Imath::V3f> {
    if constexpr (requires { kind.frame; })
      return Imath::V3f(direction_at(camera, kind.frame.right, time));
    else
      return std::nullopt;
  };
  return std::visit(right, camera.kind);
}

double central_weight(const Camera& camera, Imath::V2f film) {
  constexpr float kMiddleNm = 550;
  return static_cast<double>(
      sample_ray(without_ghosts(camera), film, {0.5F, 0.5F}, SampledSpectrum(kMiddleNm), 0, 0).weight[0]);
}

}  // namespace abbe
