#include "transport/path/smooth_scattering.h"

#include "materials/interface/mueller.h"
#include "materials/interface/snell.h"
#include "materials/material.h"
#include "scene/shapes/basis.h"
#include "scene/shapes/coordinates.h"

namespace abbe {
namespace {

using Kind = TraceEvent::Kind;

// Surface coordinates at a point; nothing on meshes, because a hit does not identify their triangle.
std::optional<SurfaceCoordinates> coordinates_at(const Shape& shape, const Imath::V3d& point) {
  const auto* placed = std::get_if<PlacedShape>(&shape);
  if (std::holds_alternative<Mesh>(shape) ||
      (placed != nullptr && std::holds_alternative<Mesh>(placed->of->shape)))
    return std::nullopt;
  return coordinates(shape, point, 0, 0);
}

// Axis of the event's frame, perpendicular to the ray before and after.
Imath::V3d axis_of(const SmoothMueller& mueller, const Imath::V3d& wo, const Imath::V3d& normal,
                   const std::optional<SurfaceCoordinates>& coordinates) {
  if (!mueller.axis) return across(wo, normal);
  const Basis<double> axes(normal, coordinates->dp_du);
  return axes.to_world(projected_axis(*mueller.axis, axes.to_local(wo)));
}

// Sets the indices of refraction of both sides.
void set_other_side(const Material& material, double wavelength_nm, bool entering, double outside,
                    Passage& passage) {
  if (const RefractiveIndex* glass = interior_index(material)) {
    const double inside = glass->n(wavelength_nm);
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

SmoothScattering smooth_scattering_at(const Scene& scene, const ExactHit& at, const Imath::V3d& wo,
                                      double wavelength_nm, double outside) {
  const ShapeInstance& shape = scene.shapes[at.shape];
  const Material& material = scene.materials[shape.material];
  const bool entering = wo.dot(at.hit.normal) > 0;
  const Imath::V3d normal = entering ? at.hit.normal : -at.hit.normal;
  SmoothLookup lookup{wavelength_nm, normal.dot(wo), !entering, outside};
  std::optional<SurfaceCoordinates> surface_coordinates;
  if (needs_coordinates(material)) surface_coordinates = coordinates_at(shape.shape, at.hit.point);
  if (surface_coordinates) lookup.coordinates = Imath::V2f(surface_coordinates->uv);
  const auto power = smooth_power(material, lookup);
  if (!power) return {};
  const SmoothMueller mueller = *smooth_mueller(material, lookup);
  if (mueller.axis && !surface_coordinates) return {};
  SmoothScattering scattering{{},
                              {},
                              axis_of(mueller, wo, at.hit.normal, surface_coordinates),
                              {outside, 0, 0, angle_deg(wo, normal), 0, power->Rs, power->Rp},
                              lobes(material).spread};
  set_other_side(material, wavelength_nm, entering, outside, scattering.passage);
  if (power->transmitted() > 0) {
    const auto through = interior_index(material) != nullptr
                             ? refract(wo, normal, scattering.passage.n_to / scattering.passage.n_from)
                             : std::optional(-wo);
    if (through)
      scattering.through = OutgoingRay{Kind::refract, through->normalized(), angle_deg(*through, -normal),
                                       FullMueller::of(mueller.matrices.through, power->transmitted())};
  }
  if (power->R() > 0) {
    const Imath::V3d direction = reflect(wo, normal);
    const bool total = !scattering.through && !opaque(material);
    scattering.reflected =
        OutgoingRay{total ? Kind::total_reflection : Kind::reflect, direction.normalized(),
                    angle_deg(direction, normal), FullMueller::of(mueller.matrices.reflected, power->R())};
  }
  return scattering;
}

}  // namespace abbe
