#include "transport/plan/make_photon_guides.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "scene/working_range.h"
#include "transport/plan/light_bounds.h"

namespace abbe {
namespace {

// Bounding box of all shapes that are not distant and whose material satisfies `holds`.
template <typename Holds>
Imath::Box3d bounds_where(const Scene& scene, Holds holds) {
  Imath::Box3d box;
  for (const ShapeInstance& shape : scene.shapes)
    if (!shape.distant && holds(scene.materials[shape.material])) box.extendBy(bounds(shape.shape));
  return box;
}

// Sphere through which photons of distant lights are sent: around all refracting and specular shapes, or
// around everything nearby if photons are the only technique.
struct TargetSphere {
  Imath::V3d center{0};
  double radius = 1;
};
TargetSphere distant_target(const Scene& scene, bool light_only) {
  const Imath::Box3d box = light_only ? scene.bounds : bounds_where(scene, [](const Material& m) {
    return lobes(m).delta || encloses_medium(m);
  });
  return box.isEmpty() ? TargetSphere{} : TargetSphere{box.center(), box.size().length() / 2};
}

// Lower bound of the cosine between `axis` and the rays from a distant light to the target. It combines the
// angle of the light's corners, viewed from the center, with that of the sphere, viewed from the light.
double min_cosine(const Imath::Box3d& light_box, const Imath::V3d& axis, const TargetSphere& target) {
  double cosine = 1;
  for (const double x : {light_box.min.x, light_box.max.x})
    for (const double y : {light_box.min.y, light_box.max.y})
      for (const double z : {light_box.min.z, light_box.max.z})
        cosine = std::min(cosine, (target.center - Imath::V3d(x, y, z)).normalized().dot(axis));
  const double sine = std::min(1.0, target.radius / distance_to(light_box, target.center));
  return cosine * std::sqrt(1 - sine * sine) - std::sqrt(std::max(0.0, 1 - cosine * cosine)) * sine;
}

// Guide of a distant light or a light at infinity; nothing for other lights.
std::optional<PhotonGuide> guide_for_distant(const Scene& scene, const Light& light,
                                             const TargetSphere& target) {
  const Imath::V3f center(target.center);
  if (const auto* directional = std::get_if<DirectionalLight>(&light.kind))
    return PhotonGuide::for_distant_light(-directional->towards, 1, center, target.radius);
  if (const auto* sun = std::get_if<SunLight>(&light.kind))
    return PhotonGuide::for_distant_light(-sun->towards, 1 - static_cast<double>(sun->cap), center,
                                          target.radius);
  const auto distant = distant_light(light, scene);
  if (!distant) return std::nullopt;
  const Imath::V3d axis = -distant->center.normalized();
  return PhotonGuide::for_distant_light(Imath::V3f(axis), min_cosine(bounds_of(light, scene), axis, target),
                                        center, target.radius);
}

// The target grows with the light's size, without bound as rays become parallel to it.
std::optional<Error> distant_light_error(const Scene& scene, const Light& light, const TargetSphere& target) {
  constexpr double kMinCosine = 0.1;
  const auto distant = distant_light(light, scene);
  if (!distant || min_cosine(bounds_of(light, scene), -distant->center.normalized(), target) >= kMinCosine)
    return std::nullopt;
  return Error(
      ErrorCode::scene, light.name,
      fmt::format(
          "photons of a distant light must arrive within 84 degrees of one direction, but this light is "
          "{:g} m across at a distance of {:g} m: use --integrator path",
          2 * distant->radius, distant->distance));
}

// A grid takes an eighth of a megabyte. If very many lights are traced, only the strongest are guided; the
// others emit unguided.
constexpr std::ptrdiff_t kMaxGuides = 128;

}  // namespace

std::optional<DistantLight> distant_light(const Light& light, const Scene& scene) {
  if (light.at_infinity() || !scene.is_distant(light)) return std::nullopt;
  const Imath::Box3d box = bounds_of(light, scene);
  return DistantLight{box.center(), box.center().length(), box.size().length() / 2};
}

std::optional<Error> refusal(const Scene& scene, const std::vector<bool>& traced, bool light_only) {
  constexpr double kSmallest = 1e-5;  // radian: smaller shapes may lack caustics
  bool any_distant = false;
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    any_distant =
        any_distant || (traced[i] && (scene.lights[i].at_infinity() || scene.is_distant(scene.lights[i])));
  if (!any_distant) return std::nullopt;
  const TargetSphere target = distant_target(scene, light_only);
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    if (traced[i])
      if (auto refused = distant_light_error(scene, scene.lights[i], target)) return refused;
  for (const ShapeInstance& shape : scene.shapes) {
    const Imath::Box3d box = bounds(shape.shape);
    const double size = box.size().length();
    const Material& material = scene.materials[shape.material];
    const bool relevant = lobes(material).delta || (light_only && shape.light < 0);
    const bool far =
        shape.distant && (relevant || is_boundary(material)) && size > kSmallest * box.center().length();
    const bool large =
        !shape.distant && (relevant || encloses_medium(material)) && size > 2 * scene.far_threshold_m;
    if (far || large)
      return Error(
          ErrorCode::scene, shape.name,
          fmt::format("photons of a distant light cannot illuminate a shape that is {:g} m across, {:g} m "
                      "from the center of the scene, if other shapes are {:g} m from the camera: use "
                      "--integrator path",
                      size, box.center().length(), scene.far_threshold_m / WorkingRange::kGap));
  }
  return std::nullopt;
}

std::vector<PhotonGuide> make_photon_guides(const Scene& scene, const std::vector<double>& traced_powers,
                                            bool light_only) {
  const Imath::Box3d box = bounds_where(scene, [](const Material& m) { return lobes(m).delta; });
  const TargetSphere target = distant_target(scene, light_only);
  std::vector<PhotonGuide> guides(scene.lights.size());
  for (std::size_t i = 0; i < guides.size(); ++i)
    if (traced_powers[i] > 0)
      if (auto guide = guide_for_distant(scene, scene.lights[i], target)) guides[i] = std::move(*guide);
  if (light_only || box.isEmpty() || guides.empty()) return guides;
  std::vector<double> strongest(traced_powers);
  const auto weakest = strongest.begin() + std::min<std::ptrdiff_t>(kMaxGuides, std::ssize(strongest)) - 1;
  std::nth_element(strongest.begin(), weakest, strongest.end(), std::greater<>());
  std::ptrdiff_t count = 0;
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    if (traced_powers[i] > 0 && traced_powers[i] >= *weakest && count++ < kMaxGuides) {
      if (scene.lights[i].at_infinity() || scene.is_distant(scene.lights[i])) {
        guides[i].enable_guiding();
        continue;
      }
      const Imath::Box3d light_box = bounds_of(scene.lights[i], scene);
      const auto* spot = std::get_if<SpotLight>(&scene.lights[i].kind);
      guides[i] =
          PhotonGuide(Imath::V3f(light_box.center()), static_cast<float>(light_box.size().length() / 2),
                      Imath::V3f(box.center()), static_cast<float>(box.size().length() / 2),
                      spot != nullptr ? std::optional(spot->axis) : std::nullopt);
    }
  return guides;
}

}  // namespace abbe
