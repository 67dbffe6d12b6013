#include "scene/camera/camera.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "scene/camera/perspective.h"

namespace abbe {
namespace {

Imath::V3f moved_point(const Imath::V3f& point, const Imath::M44d& by) {
  return Imath::V3f(Imath::V3d(point) * by);
}

Ray moved_ray(const Ray& ray, const Imath::M44d& by) {
  return {moved_point(ray.origin, by), Imath::V3f(moved_direction(Imath::V3d(ray.direction), by)), ray.t_max,
          ray.time};
}

void turn(std::optional<WavelengthImages>& images, const Imath::M44d& by) {
  if (images) images->jones.axis = Imath::V3f(moved_direction(Imath::V3d(images->jones.axis), by));
}

Imath::M44d motion_until(const Camera& camera, float time) {
  return camera.motion->since_opening(static_cast<double>(time));
}

void move(CameraRay& ray, const Camera& camera, float time) {
  const Imath::M44d since_opening = motion_until(camera, time);
  ray.ray = moved_ray(ray.ray, since_opening);
  turn(ray.images, since_opening);
}

// Origin of a ray that leaves the probe, offset from whatever the probe lies on.
Imath::V3f probe_ray_origin(const Camera& probe, const Ray& ray) {
  const Imath::V3f at_rest = probe_normal(probe, ray_in_rest_frame(probe, ray).origin);
  const Imath::V3f normal(direction_at(probe, Imath::V3d(at_rest), ray.time));
  return offset_point(ray.origin, normal, normal);
}

// Twice the mean squared radius of an opening in the unit circle, which is 1 for the disc. The squared radius
// of an iris point is proportional to that of its disc point, so that the rim suffices.
double mean_square(const std::optional<lens::Iris>& iris) {
  if (!iris) return 1;
  constexpr int kAngles = 7200;
  double sum = 0;
  for (int i = 0; i < kAngles; ++i) {
    const double angle = 2 * std::numbers::pi * (i + 0.5) / kAngles;
    sum += iris->point({std::cos(angle), std::sin(angle)}).length2();
  }
  return sum / kAngles;
}

// Mean of cos^4 = 1/(1 + t^2)^2 over the tangents t in a disc of radius k about the tangent u. It is the
// projected solid angle of a disc seen from an element of a parallel plane, divided by the disc's area:
//     2/(B (A + B)),  A = 1 + u^2 - k^2,  B^2 = A^2 + 4 k^2.
double mean_cos4(double u, double k) {
  const double a = 1 + u * u - k * k;
  const double b = std::hypot(a, 2 * k);
  return 2 / (b * (a + b));
}

constexpr std::uint32_t kRays = 4096;
constexpr std::size_t kGroups = 32;  // groups of rays with similar angles
constexpr double kSameSine2 = 1e-9;  // smaller differences count as one angle
constexpr float kReferenceNm = 550;

// Squared sine of a ray's angle of incidence, on which filter shifts depend, and its irradiance.
struct WeightedAngle {
  double sine2;
  double weight;
};

// Point i of Hammersley's set of `kRays` points in the unit square: (i + 1/2)/kRays, and the radical inverse
// of i in base 2 [Pharr2023, sec. 8.6].
Imath::V2f hammersley(std::uint32_t i) {
  float mirrored = 0.5F / kRays;
  float digit = 0.5F;
  for (std::uint32_t rest = i; rest > 0; rest /= 2, digit /= 2)
    if (rest % 2 == 1) mirrored += digit;
  return {(static_cast<float>(i) + 0.5F) / kRays, mirrored};
}

std::vector<WeightedAngle> angles_over_lens(const Camera& camera, Imath::V2f film) {
  const Camera image_camera = without_ghosts(camera);
  std::vector<WeightedAngle> angles;
  for (std::uint32_t i = 0; i < kRays; ++i) {
    const CameraRay ray = sample_ray(image_camera, film, hammersley(i), SampledSpectrum(kReferenceNm), 0, 0);
    const auto weight = static_cast<double>(ray.weight[0]);
    const auto cos_film = static_cast<double>(ray.cos_film);
    if (weight > 0) angles.push_back({(1 - cos_film) * (1 + cos_film), weight});
  }
  return angles;
}

}  // namespace

CameraRay sample_ray(const Camera& camera, Imath::V2f film, Imath::V2f lens,
                     const SampledSpectrum& wavelengths_nm, int hero, float time) {
  const CameraSample sample{film, lens, wavelengths_nm, hero, time};
  CameraRay ray =
      std::visit([&](const auto& kind) { return kind.sample_ray(camera.film(), sample); }, camera.kind);
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
  const CameraSample sample{{0, 0}, lens, wavelengths_nm, 0, time};
  const auto connect = [&](const Imath::V3f& at_rest) {
    return std::visit([&](const auto& kind) { return kind.sample_towards(camera.film(), at_rest, sample); },
                      camera.kind);
  };
  if (!camera.motion) return connect(point);
  const Imath::M44d since_opening = motion_until(camera, time);
  std::optional<CameraConnection> connection = connect(moved_point(point, rigid_inverse(since_opening)));
  if (!connection) return connection;
  connection->lens_point = moved_point(connection->lens_point, since_opening);
  turn(connection->images, since_opening);
  return connection;
}

std::optional<CameraDensity> density(const Camera& camera, const Ray& ray,
                                     const SampledSpectrum& wavelengths_nm, LensRoute route) {
  const Ray& at_rest = camera.motion ? ray_in_rest_frame(camera, ray) : ray;
  std::optional<CameraDensity> of = std::visit(
      [&](const auto& kind) { return kind.density(camera.film(), at_rest, wavelengths_nm, route); },
      camera.kind);
  if (camera.motion && of) turn(of->images, motion_until(camera, ray.time));
  return of;
}

std::optional<CameraConnection> connection_through(const Camera& camera, const Opening& opening,
                                                   const Ray& light, const SampledSpectrum& wavelengths_nm) {
  const std::optional<double> distance = crossing(opening, ray_in_rest_frame(camera, light));
  if (!distance) return std::nullopt;
  const Imath::V3f point(Imath::V3d(light.origin) + Imath::V3d(light.direction) * *distance);
  const Ray back = ray_at(point, -light.direction, light.time);
  const auto camera_density = density(camera, back, wavelengths_nm);
  if (!camera_density) return std::nullopt;
  return CameraConnection{
      camera_density->film,         is_probe(camera) ? probe_ray_origin(camera, back) : point,
      camera_density->pdf_position, camera_density->importance,
      camera_density->cos_film,     camera_density->images};
}

std::optional<GhostEntrance> sample_ghost(const Camera& camera, Imath::V2f lens, float time) {
  const auto* kind = std::get_if<LensSystem>(&camera.kind);
  auto entrance = kind != nullptr ? kind->sample_ghost(lens) : std::nullopt;
  if (!camera.motion || !entrance) return entrance;
  const Imath::M44d since_opening = motion_until(camera, time);
  entrance->point = moved_point(entrance->point, since_opening);
  entrance->normal = Imath::V3f(moved_direction(Imath::V3d(entrance->normal), since_opening));
  return entrance;
}

Camera without_ghosts(Camera camera) {
  if (auto* lens = std::get_if<LensSystem>(&camera.kind)) lens->ghosts = false;
  return camera;
}

Ray ray_in_rest_frame(const Camera& camera, const Ray& ray) {
  return camera.motion ? moved_ray(ray, rigid_inverse(motion_until(camera, ray.time))) : ray;
}

Imath::V3d direction_at(const Camera& camera, const Imath::V3d& direction, float time) {
  return camera.motion ? moved_direction(direction, motion_until(camera, time)) : direction;
}

double min_film_cosine(const Camera& camera) {
  return std::visit([&](const auto& kind) { return kind.min_film_cosine(camera.film()); }, camera.kind);
}

CameraTraits traits(const Camera& camera) {
  return std::visit([](const auto& kind) { return kind.traits(); }, camera.kind);
}

const Imath::V3d& position(const Camera& camera) {
  return std::visit([](const auto& kind) -> const Imath::V3d& { return kind.position(); }, camera.kind);
}

Imath::V3d center(const Camera& camera) {
  return std::visit([](const auto& kind) { return kind.center(); }, camera.kind);
}

void translate(Camera& camera, const Imath::V3d& by) {
  std::visit([&](auto& kind) { kind.translate(by); }, camera.kind);
}

bool is_probe(const Camera& camera) {
  return std::holds_alternative<IrradianceProbe>(camera.kind);
}

Imath::V3f probe_normal(const Camera& probe, const Imath::V3f& point) {
  return std::get<IrradianceProbe>(probe.kind).normal_at(point);
}

Imath::Box3d bounds(const Camera& camera) {
  const Imath::V3d at = center(camera);
  const std::optional<Opening> opening = traits(camera).opening;
  constexpr double kMargin = 1.01;  // rays start off the surface
  const double radius = opening ? kMargin * opening_radius(*opening) : (at - position(camera)).length();
  Imath::Box3d box(at - Imath::V3d(radius), at + Imath::V3d(radius));
  if (!camera.motion) return box;
  const Imath::Box3d path = camera.motion->sweep({at}, 0, 1);
  return {path.min - Imath::V3d(radius), path.max + Imath::V3d(radius)};
}

Imath::V3f probe_point(const Camera& probe, Imath::V2f uv) {
  const FilmGrid film = probe.film();
  const Imath::V2f at(uv.x * static_cast<float>(film.width), uv.y * static_cast<float>(film.height));
  return std::get<IrradianceProbe>(probe.kind).sample_ray(film, {at, {0.5F, 0.5F}, {}}).ray.origin;
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
  constexpr float kReferenceNm = 550;
  return static_cast<double>(
      sample_ray(without_ghosts(camera), film, {0.5F, 0.5F}, SampledSpectrum(kReferenceNm), 0, 0).weight[0]);
}

double opening_tangent(const Camera& camera) {
  const auto* lens = std::get_if<ThinLens>(&camera.kind);
  if (lens == nullptr) return 0;
  return lens->aperture_radius * std::sqrt(mean_square(lens->iris)) / lens->focus_distance;
}

double mean_weight(const Camera& camera, double opening_tangent, Imath::V2f film) {
  const double central = central_weight(camera, film);
  if (opening_tangent == 0) return central;
  const double u = film_plane(camera.film(), film).length() / traits(camera).image_distance.value();
  return central * mean_cos4(u, opening_tangent) / mean_cos4(u, 0);
}

std::vector<Incidence> incidence_angles(const Camera& camera, Imath::V2f film) {
  std::vector<WeightedAngle> rays = angles_over_lens(camera, film);
  if (rays.empty()) return {};
  std::sort(rays.begin(), rays.end(),
            [](const WeightedAngle& a, const WeightedAngle& b) { return a.sine2 < b.sine2; });
  const bool is_single_angle = rays.back().sine2 - rays.front().sine2 < kSameSine2;
  const std::size_t groups = is_single_angle ? 1 : std::min(kGroups, rays.size());
  std::vector<Incidence> angles;
  double total_weight = 0;
  for (std::size_t group = 0; group < groups; ++group) {
    double weight = 0;
    double sine2 = 0;
    for (std::size_t i = group * rays.size() / groups; i < (group + 1) * rays.size() / groups; ++i) {
      weight += rays[i].weight;
      sine2 += rays[i].weight * rays[i].sine2;
    }
    angles.push_back({std::sqrt(1 - sine2 / weight), weight});
    total_weight += weight;
  }
  for (Incidence& angle : angles) angle.fraction /= total_weight;
  return angles;
}

}  // namespace abbe
