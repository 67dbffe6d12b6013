#include "transport/path/ray_trace.h"

#include <cmath>
#include <numbers>

#include "materials/interface/snell.h"

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

Turn refract_or_reflect(const DielectricMaterial& glass, const Imath::V3d& wo, const Imath::V3d& outward,
                        double wavelength_nm) {
  const bool entering = wo.dot(outward) > 0;
  const Imath::V3d normal = entering ? outward : -outward;
  const double inside = glass.index.n(wavelength_nm);
  const double n_from = entering ? 1 : inside;
  const double n_to = entering ? inside : 1;
  const FresnelPower<double> power =
      coated_power(glass.coating, wavelength_nm, inside, 0, normal.dot(wo), !entering);
  const std::optional<Imath::V3d> through = refract(wo, normal, n_to / n_from);
  const Imath::V3d direction = through ? *through : reflect(wo, normal);
  return {through ? Kind::refract : Kind::total_reflection,
          direction,
          {n_from, n_to, 0, angle_deg(wo, normal), angle_deg(direction, through ? -normal : normal), power.Rs,
           power.Rp}};
}

Turn mirror(const ConductorMaterial& metal, const Imath::V3d& wo, const Imath::V3d& outward,
            double wavelength_nm) {
  const Imath::V3d normal = wo.dot(outward) > 0 ? outward : -outward;
  const double n = metal.index.n(wavelength_nm);
  const double k = metal.index.k(wavelength_nm);
  const FresnelPower<double> power = coated_power(metal.coating, wavelength_nm, n, k, normal.dot(wo), false);
  const Imath::V3d direction = reflect(wo, normal);
  return {Kind::reflect,
          direction,
          {1, n, k, angle_deg(wo, normal), angle_deg(direction, normal), power.Rs, power.Rp}};
}

std::optional<Turn> turn(const Material& material, const Imath::V3d& wo, const Imath::V3d& outward,
                         double wavelength_nm) {
  if (const auto* glass = std::get_if<DielectricMaterial>(&material.model))
    return refract_or_reflect(*glass, wo, outward, wavelength_nm);
  if (const auto* metal = std::get_if<ConductorMaterial>(&material.model))
    return mirror(*metal, wo, outward, wavelength_nm);
  return std::nullopt;
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
  while (static_cast<int>(trace.events.size()) < max_events) {
    const double nearest = trace.events.empty() ? 0 : kSelf * (size + now.origin.length());
    const std::optional<ExactHit> hit = intersect_exact(scene, now, nearest);
    if (!hit) {
      trace.events.push_back({Kind::escape, {}, 0, {}});
      trace.cut_short = false;
      break;
    }
    const Material& material = scene.materials[scene.shapes[hit->shape].material];
    const std::optional<Turn> next = turn(material, -now.direction, hit->hit.normal, wavelength_nm);
    now.origin = hit->hit.point;
    if (!next) {
      trace.events.push_back({Kind::hit, hit->hit, hit->shape, {}});
      trace.cut_short = false;
      break;
    }
    now.direction = next->direction.normalized();
    trace.events.push_back({next->kind, hit->hit, hit->shape, next->passage});
  }
  return trace;
}

}  // namespace abbe
