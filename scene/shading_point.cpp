#include "scene/shading_point.h"

#include "scene/shapes/shape.h"

namespace abbe {

namespace {

Imath::V3d turned(const NormalMap& map, const SurfaceCoordinates& at, const Imath::V3d& normal) {
  const Basis<double> axes(normal, at.dp_du);
  const Imath::V3d n = map.normal(Imath::V2f(at.uv));
  return axes.to_world({n.x, axes.y.dot(at.dp_dv) < 0 ? -n.y : n.y, n.z});
}

// Tilts the normal against the gradient g along the surface, which has the slopes g.dp_du and g.dp_dv. The
// curvature of the surface itself is neglected. [Blinn1978]
Imath::V3d turned(const BumpMap& map, const SurfaceCoordinates& at, const Imath::V3d& normal) {
  const Imath::V3d area = at.dp_du.cross(at.dp_dv);
  if (area.length2() == 0) return normal;
  const Imath::V2d slope = map.slope(Imath::V2f(at.uv));
  const Imath::V3d gradient =
      (at.dp_dv.cross(area) * slope.x + area.cross(at.dp_du) * slope.y) / area.length2();
  return (normal - gradient).normalized();
}

}  // namespace

ShadingPoint textured_shading_point(const Scene& scene, const SurfaceHit& hit, float time) {
  const ShapeInstance& instance = scene.shapes[hit.shape];
  const Material& material = scene.materials[instance.material];
  const Imath::V3d point(hit.point);
  const auto smooth = interpolated_normal(instance.shape, point, hit.primitive, Imath::V3d(hit.normal), time);
  const Imath::V3f normal = smooth ? Imath::V3f(*smooth) : hit.normal;
  const bool relief = smooth || material.relief;
  if (!needs_coordinates(material)) return {Basis<float>(normal), {0, 0}, relief};
  const SurfaceCoordinates at = coordinates(instance.shape, point, hit.primitive, time);
  const Imath::V3f along(at.dp_du.normalized());
  if (!material.relief) return {Basis<float>(normal, along), Imath::V2f(at.uv), relief};
  const Imath::V3d carved =
      std::visit([&](const auto& map) { return turned(map, at, Imath::V3d(normal)); }, *material.relief);
  return {Basis<float>(Imath::V3f(carved), along), Imath::V2f(at.uv), relief};
}

}  // namespace abbe
