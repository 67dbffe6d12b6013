#include "transport/plan/aiming.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "scene/extent.h"
#include "transport/plan/light_bounds.h"

namespace abbe {
namespace {

// Around all shapes that are not far and whose material `holds`, as what photons are aimed at.
template <typename Holds>
Imath::Box3d bounds_where(const Scene& scene, Holds holds) {
  Imath::Box3d box;
  for (const ShapeInstance& shape : scene.shapes)
    if (!shape.far && holds(scene.materials[shape.material])) box.extendBy(bounds(shape.shape));
  return box;
}

// What photons from afar are sent through: a sphere around what may bend them, or around all that is near.
struct AimingSphere {
  Imath::V3d center{0};
  double radius = 1;
};
AimingSphere target_from_afar(const Scene& scene, bool light_only) {
  const Imath::Box3d box = light_only ? scene.bounds : bounds_where(scene, [](const Material& m) {
    return lobes(m).delta || encloses_medium(m);
  });
  return box.isEmpty() ? AimingSphere{} : AimingSphere{box.center(), box.size().length() / 2};
}

// Of the angle that rays from a far lamp to the target make with `axis` at most: that of the lamp's corners
// as seen from the middle, and of the sphere as seen from the lamp.
double least_cosine(const Imath::Box3d& lamp, const Imath::V3d& axis, const AimingSphere& target) {
  double cosine = 1;
  for (const double x : {lamp.min.x, lamp.max.x})
    for (const double y : {lamp.min.y, lamp.max.y})
      for (const double z : {lamp.min.z, lamp.max.z})
        cosine = std::min(cosine, (target.center - Imath::V3d(x, y, z)).normalized().dot(axis));
  const double sine = std::min(1.0, target.radius / distance_to(lamp, target.center));
  return cosine * std::sqrt(1 - sine * sine) - std::sqrt(std::max(0.0, 1 - cosine * cosine)) * sine;
}

// For a light that is far or at infinity; nothing for the others.
std::optional<Aim> aim_from_afar(const Scene& scene, const Light& light, const AimingSphere& target) {
  const Imath::V3f center(target.center);
  if (const auto* beam = std::get_if<DirectionalLight>(&light.kind))
    return Aim::from_afar(-beam->towards, 1, center, target.radius);
  if (const auto* sun = std::get_if<SunLight>(&light.kind))
    return Aim::from_afar(-sun->towards, 1 - static_cast<double>(sun->cap), center, target.radius);
  const auto lamp = far_away(light, scene);
  if (!lamp) return std::nullopt;
  const Imath::V3d axis = -lamp->center.normalized();
  return Aim::from_afar(Imath::V3f(axis), least_cosine(bounds_of(light, scene), axis, target), center,
                        target.radius);
}

// The target grows with a lamp's size, and has an end where rays run along it.
std::optional<Error> refusal_of_lamp(const Scene& scene, const Light& light, const AimingSphere& target) {
  constexpr double kLeastCosine = 0.1;
  const auto lamp = far_away(light, scene);
  if (!lamp || least_cosine(bounds_of(light, scene), -lamp->center.normalized(), target) >= kLeastCosine)
    return std::nullopt;
  return Error(
      ErrorCode::scene, light.name,
      fmt::format("photons of a lamp from afar come within 84 degrees of one direction: it is {:g} m "
                  "across and {:g} m away; --integrator path renders it",
                  2 * lamp->radius, lamp->distance));
}

// Aims cost an eighth of a megabyte for each of their grids, so that of very many traced lights only the
// strongest have one; the others shine everywhere.
constexpr std::ptrdiff_t kMostAims = 128;

}  // namespace

std::optional<FarLight> far_away(const Light& light, const Scene& scene) {
  if (light.at_infinity() || !scene.is_far(light)) return std::nullopt;
  const Imath::Box3d box = bounds_of(light, scene);
  return FarLight{box.center(), box.center().length(), box.size().length() / 2};
}

std::optional<Error> refusal(const Scene& scene, const std::vector<bool>& traced, bool light_only) {
  constexpr double kSmallest = 1e-5;  // of a radian: less of the view than this may go without caustics
  bool from_afar = false;
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    from_afar = from_afar || (traced[i] && (scene.lights[i].at_infinity() || scene.is_far(scene.lights[i])));
  if (!from_afar) return std::nullopt;
  const AimingSphere target = target_from_afar(scene, light_only);
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    if (traced[i])
      if (auto refused = refusal_of_lamp(scene, scene.lights[i], target)) return refused;
  for (const ShapeInstance& shape : scene.shapes) {
    const Imath::Box3d box = bounds(shape.shape);
    const double size = box.size().length();
    const Material& material = scene.materials[shape.material];
    const bool met = lobes(material).delta || (light_only && shape.light < 0);
    const bool far = shape.far && (met || is_boundary(material)) && size > kSmallest * box.center().length();
    const bool large = !shape.far && (met || encloses_medium(material)) && size > 2 * scene.far_from_m;
    if (far || large)
      return Error(ErrorCode::scene, shape.name,
                   fmt::format("photons of a light from afar cannot light a shape {:g} m across, {:g} m from "
                               "the middle of the scene, beside what is {:g} m from the camera: --integrator "
                               "path renders it",
                               size, box.center().length(), scene.far_from_m / Extent::kGap));
  }
  return std::nullopt;
}

std::vector<Aim> make_aims(const Scene& scene, const std::vector<double>& traced_powers, bool light_only) {
  const Imath::Box3d box = bounds_where(scene, [](const Material& m) { return lobes(m).delta; });
  const AimingSphere target = target_from_afar(scene, light_only);
  std::vector<Aim> aims(scene.lights.size());
  for (std::size_t i = 0; i < aims.size(); ++i)
    if (traced_powers[i] > 0)
      if (auto aim = aim_from_afar(scene, scene.lights[i], target)) aims[i] = std::move(*aim);
  if (light_only || box.isEmpty() || aims.empty()) return aims;
  std::vector<double> strongest(traced_powers);
  const auto least = strongest.begin() + std::min<std::ptrdiff_t>(kMostAims, std::ssize(strongest)) - 1;
  std::nth_element(strongest.begin(), least, strongest.end(), std::greater<>());
  std::ptrdiff_t count = 0;
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    if (traced_powers[i] > 0 && traced_powers[i] >= *least && count++ < kMostAims) {
      if (scene.lights[i].at_infinity() || scene.is_far(scene.lights[i])) {
        aims[i].guide();
        continue;
      }
      const Imath::Box3d lamp = bounds_of(scene.lights[i], scene);
      const auto* spot = std::get_if<SpotLight>(&scene.lights[i].kind);
      aims[i] = Aim(Imath::V3f(lamp.center()), static_cast<float>(lamp.size().length() / 2),
                    Imath::V3f(box.center()), static_cast<float>(box.size().length() / 2),
                    spot != nullptr ? std::optional(spot->axis) : std::nullopt);
    }
  return aims;
}

}  // namespace abbe
