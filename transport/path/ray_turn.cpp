#include "transport/path/ray_turn.h"

#include "materials/interface/snell.h"
#include "materials/interface/thin_element.h"
#include "materials/smooth_power.h"
#include "scene/shapes/basis.h"
#include "scene/shapes/coordinates.h"

namespace abbe {
namespace {

using Kind = TraceEvent::Kind;

// Unknown on meshes, as a hit does not tell their triangle.
std::optional<SurfaceCoordinates> coordinates_at(const Shape& shape, const Imath::V3d& point) {
  const auto* placed = std::get_if<PlacedShape>(&shape);
  if (std::holds_alternative<Mesh>(shape) ||
      (placed != nullptr && std::holds_alternative<Mesh>(placed->of->shape)))
    return std::nullopt;
  return coordinates(shape, point, 0, 0);
}

// The axis of what happens, across the ray from `wo` before and after.
Imath::V3d axis_of(const SmoothMueller& mueller, const Imath::V3d& wo, const Imath::V3d& normal,
                   const std::optional<SurfaceCoordinates>& place) {
  if (!mueller.axis) return across(wo, normal);
  const Basis<double> axes(normal, place->dp_du);
  return axes.to_world(projected_axis(*mueller.axis, axes.to_local(wo)));
}

// The indices of the other side, as the passage has them.
void set_other_side(const Material& material, double wavelength_nm, bool entering, double outside,
                    Passage& passage) {
  if (const auto* glass = std::get_if<DielectricMaterial>(&material.model)) {
    const double inside = glass->index.n(wavelength_nm);
    passage.n_from = entering ? outside : inside;
    passage.n_to = entering ? inside : outside;
  } else if (const auto* metal = std::get_if<ConductorMaterial>(&material.model)) {
    passage.n_to = metal->index.n(wavelength_nm);
    passage.k_to = metal->index.k(wavelength_nm);
  } else if (!opaque(material)) {
    passage.n_to = outside;
  }
}

}  // namespace

Turn turn_at(const Scene& scene, const ExactHit& at, const Imath::V3d& wo, double wavelength_nm,
             double outside) {
  const ShapeInstance& shape = scene.shapes[at.shape];
  const Material& material = scene.materials[shape.material];
  const bool entering = wo.dot(at.hit.normal) > 0;
  const Imath::V3d normal = entering ? at.hit.normal : -at.hit.normal;
  SmoothLookup lookup{wavelength_nm, normal.dot(wo), !entering, outside};
  std::optional<SurfaceCoordinates> place;
  if (needs_coordinates(material)) place = coordinates_at(shape.shape, at.hit.point);
  if (place) lookup.coordinates = Imath::V2f(place->uv);
  const auto power = smooth_power(material, lookup);
  if (!power) return {};
  const SmoothMueller mueller = *smooth_mueller(material, lookup);
  if (mueller.axis && !place) return {};
  Turn turn{{},
            {},
            axis_of(mueller, wo, at.hit.normal, place),
            {outside, 0, 0, angle_deg(wo, normal), 0, power->Rs, power->Rp},
            lobes(material).spread};
  set_other_side(material, wavelength_nm, entering, outside, turn.passage);
  if (power->transmitted() > 0) {
    const bool bends = std::holds_alternative<DielectricMaterial>(material.model);
    const auto through =
        bends ? refract(wo, normal, turn.passage.n_to / turn.passage.n_from) : std::optional(-wo);
    if (through)
      turn.through = RayWay{Kind::refract, through->normalized(), angle_deg(*through, -normal),
                            FullMueller::of(mueller.ways.through, power->transmitted())};
  }
  if (power->R() > 0) {
    const Imath::V3d direction = reflect(wo, normal);
    const bool total = !turn.through && !opaque(material);
    turn.reflected =
        RayWay{total ? Kind::total_reflection : Kind::reflect, direction.normalized(),
               angle_deg(direction, normal), FullMueller::of(mueller.ways.reflected, power->R())};
  }
  return turn;
}

}  // namespace abbe
