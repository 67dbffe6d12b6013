#include "transport/path/ray_trace.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "materials/interface/snell.h"
#include "transport/path/interface.h"

namespace abbe {
namespace {

using Kind = TraceEvent::Kind;

// A hit nearer than this share of the distances involved is the surface the ray starts from.
constexpr double kSelf = 1e-11;

struct Turn {
  Kind kind;
  Imath::V3d direction;
  Passage passage;
};

// `outside` is the index of what the glass, or the metal below, is in.
Turn refract_or_reflect(const DielectricMaterial& glass, const Imath::V3d& wo, const Imath::V3d& outward,
                        double wavelength_nm, double outside) {
  const bool entering = wo.dot(outward) > 0;
  const Imath::V3d normal = entering ? outward : -outward;
  const double inside = glass.index.n(wavelength_nm);
  const double n_from = entering ? outside : inside;
  const double n_to = entering ? inside : outside;
  const FresnelPower<double> power =
      coated_power(glass.coating, wavelength_nm, inside, 0, normal.dot(wo), !entering, outside);
  const std::optional<Imath::V3d> through = refract(wo, normal, n_to / n_from);
  const Imath::V3d direction = through ? *through : reflect(wo, normal);
  return {through ? Kind::refract : Kind::total_reflection,
          direction,
          {n_from, n_to, 0, angle_deg(wo, normal), angle_deg(direction, through ? -normal : normal), power.Rs,
           power.Rp}};
}

Turn mirror(const ConductorMaterial& metal, const Imath::V3d& wo, const Imath::V3d& outward,
            double wavelength_nm, double outside) {
  const Imath::V3d normal = wo.dot(outward) > 0 ? outward : -outward;
  const double n = metal.index.n(wavelength_nm);
  const double k = metal.index.k(wavelength_nm);
  const FresnelPower<double> power =
      coated_power(metal.coating, wavelength_nm, n, k, normal.dot(wo), false, outside);
  const Imath::V3d direction = reflect(wo, normal);
  return {Kind::reflect,
          direction,
          {outside, n, k, angle_deg(wo, normal), angle_deg(direction, normal), power.Rs, power.Rp}};
}

std::optional<Turn> turn(const Material& material, const Imath::V3d& wo, const Imath::V3d& outward,
                         double wavelength_nm, double outside) {
  if (const auto* glass = std::get_if<DielectricMaterial>(&material.model))
    return refract_or_reflect(*glass, wo, outward, wavelength_nm, outside);
  if (const auto* metal = std::get_if<ConductorMaterial>(&material.model))
    return mirror(*metal, wo, outward, wavelength_nm, outside);
  if (!is_boundary(material)) return std::nullopt;
  const double angle = angle_deg(wo, wo.dot(outward) > 0 ? outward : -outward);
  return Turn{Kind::refract, -wo, {outside, outside, 0, angle, angle, 0, 0}};
}

// What a ray meets at once: in scenes of nested matter all surfaces that touch.
struct Meeting {
  ExactHit acting;
  ActingSurface boundary;
  double spread;  // how far apart the surfaces are, along the normal
};

Meeting meet(const Scene& scene, const BasicRay<double>& ray, const ExactHit& first, double nearest,
             const MediumStack& inside) {
  if (!scene.needs.nesting) return {first, {0}, 0};
  const Imath::V3d& normal = first.hit.normal;
  BasicRay<double> rest = ray;
  rest.t_max =
      first.hit.t + scene.touch_distance(first.hit.point, first.shape) / std::abs(normal.dot(ray.direction));
  std::vector<ExactHit> met{first};
  double spread = 0;
  for (std::uint32_t i = 0; i < scene.shapes.size() && met.size() < TouchingSurfaces::kMost; ++i) {
    const auto hit = i == first.shape ? std::nullopt : intersect(scene.shapes[i].shape, rest, nearest);
    if (!hit || std::abs(hit->normal.dot(normal)) <= TouchingSurfaces::kParallel) continue;
    const double apart = std::abs((hit->point - first.hit.point).dot(normal));
    if (apart > scene.touch_distance(first.hit.point, first.shape, i)) continue;
    spread = std::max(spread, apart);
    met.push_back({*hit, i});
  }
  std::vector<CrossedSurface> crossed;
  for (const ExactHit& hit : met) crossed.push_back({hit.shape, hit.hit.normal.dot(ray.direction) < 0});
  ActingSurface boundary = acting_surface(scene, crossed, inside);
  return {met[boundary.acting.value_or(0)], boundary, spread};
}

}  // namespace

double angle_deg(const Imath::V3d& a, const Imath::V3d& b) {
  const Imath::V3d u = a.normalized();
  const Imath::V3d v = b.normalized();
  return 2 * std::atan2((u - v).length(), (u + v).length()) * 180 / std::numbers::pi;
}

RayTrace trace_ray(const Scene& scene, const BasicRay<double>& ray, double wavelength_nm, int max_events) {
  RayTrace trace{{}, ray, true};
  BasicRay<double>& now = trace.last;
  const double size = scene.bounds.isEmpty() ? 0 : scene.bounds.size().length();
  MediumStack inside = scene.needs.nesting ? enclosing(scene, Imath::V3f(ray.origin)) : MediumStack{};
  double nearest = 0;
  while (static_cast<int>(trace.events.size()) < max_events) {
    const std::optional<ExactHit> hit = intersect_exact(scene, now, nearest);
    if (!hit) {
      trace.events.push_back({Kind::escape, {}, 0, {}});
      trace.cut_short = false;
      break;
    }
    const auto [acting, boundary, spread] = meet(scene, now, *hit, nearest, inside);
    now.origin = acting.hit.point;
    bool through = true;
    if (boundary.acting) {
      const double outside = boundary.outside != nullptr ? boundary.outside->n(wavelength_nm) : 1;
      const Material& material = scene.materials[scene.shapes[acting.shape].material];
      const std::optional<Turn> next =
          turn(material, -now.direction, acting.hit.normal, wavelength_nm, outside);
      if (!next) {
        trace.events.push_back({Kind::hit, acting.hit, acting.shape, {}});
        trace.cut_short = false;
        break;
      }
      now.direction = next->direction.normalized();
      trace.events.push_back({next->kind, acting.hit, acting.shape, next->passage});
      through = next->kind == Kind::refract;
    }
    if (through) inside = boundary.beyond;
    nearest = kSelf * (size + now.origin.length()) + spread / std::abs(acting.hit.normal.dot(now.direction));
  }
  return trace;
}

}  // namespace abbe
