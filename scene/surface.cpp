#include "scene/surface.h"

#include "scene/shapes/coordinates.h"

namespace abbe {

SurfacePlace textured_place(const Scene& scene, const SurfaceHit& hit) {
  const ShapeInstance& instance = scene.shapes[hit.shape];
  const Material& material = scene.materials[instance.material];
  if (!needs_coordinates(material)) return {Basis<float>(hit.normal)};
  const SurfaceCoordinates at = coordinates(instance.shape, Imath::V3d(hit.point), hit.primitive);
  return {Basis<float>(hit.normal, Imath::V3f(at.dp_du.normalized())), Imath::V2f(at.uv)};
}

}  // namespace abbe
