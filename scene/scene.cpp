#include "scene/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "scene/coincident_shapes.h"
#include "scene/geometry.h"
#include "scene/shapes/shape.h"
#include "scene/working_range.h"

namespace abbe {
namespace {

// A point on a surface is off it by up to one float step per axis. The origin of a ray is offset by four
// more, and by up to half a step per axis from rounding: seven together. Nearer surfaces are hit together,
// farther ones by the ray that leaves.
double tolerance_at(double size) {
  return 8 * float_step(size);
}

// Volume that a shape encloses. That of a prototype is computed once.
double volume_of(const Shape& shape, std::map<const Prototype*, double>& of_prototypes) {
  const auto volume = [&] { return visit_plain([](const auto& s) { return enclosed_volume(s); }, shape); };
  const auto* placed = std::get_if<PlacedShape>(&shape);
  if (placed == nullptr) return volume();
  const auto [known, added] = of_prototypes.emplace(placed->of.get(), 0);
  if (added) known->second = volume();
  return known->second * std::abs(placed->at->to_world.determinant());
}

// Bounding box of all shapes of each material.
std::vector<Imath::Box3d> boxes_of_materials(const Scene& scene) {
  std::vector<Imath::Box3d> boxes(scene.materials.size());
  for (const ShapeInstance& instance : scene.shapes)
    boxes[instance.material].extendBy(bounds(instance.shape));
  return boxes;
}

// Tabulates multiple scattering of rough dielectrics in each medium of the scene that may surround them.
void tabulate_in_media(Scene& scene) {
  std::vector<Imath::Box3d> boxes;
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    auto* rough = std::get_if<RoughDielectricMaterial>(&scene.materials[i].model);
    if (rough == nullptr) continue;
    if (boxes.empty()) boxes = boxes_of_materials(scene);
    Imath::Box3d box = boxes[i];
    if (box.isEmpty()) continue;
    const Imath::V3d margin(scene.coincidence_tolerance());
    box = {box.min - margin, box.max + margin};
    for (std::size_t j = 0; j < scene.materials.size(); ++j) {
      const RefractiveIndex* medium = interior_index(scene.materials[j]);
      if (j != i && medium != nullptr && box.intersects(boxes[j])) rough->tabulate_in(*medium);
    }
  }
}

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

std::vector<std::string> Scene::channel_names() const {
  std::vector<std::string> names;
  for (const Channel& channel : channels) names.push_back(channel.name);
  return names;
}

std::vector<std::string> Scene::film_planes() const {
  return mosaic ? std::vector<std::string>{kRawPlane} : channel_names();
}

std::optional<SurfaceHit> Scene::intersect(const Ray& ray) const {
  return geometry_->intersect(ray);
}

CoincidentHits Scene::coincident(const Ray& ray, const SurfaceHit& hit) const {
  return geometry_->coincident(*this, ray, hit);
}

bool Scene::wall_within_rounding(const SurfaceHit& hit, const Imath::V3f& direction, float time) const {
  return geometry_->wall_within_rounding(*this, hit, direction, time);
}

double Scene::coincidence_tolerance(const Imath::V3d& point, std::uint32_t shape, std::uint32_t other) const {
  return tolerance_at(std::max({largest_coordinate(point), shapes[shape].rounding, shapes[other].rounding}));
}

double Scene::coincidence_tolerance(const Imath::V3d& point, std::uint32_t shape) const {
  return tolerance_at(std::max({largest_coordinate(point), shapes[shape].rounding, max_rounding_}));
}

double Scene::coincidence_tolerance() const {
  return tolerance_at(largest_coordinate(bounds));
}

bool Scene::occluded(const Imath::V3f& from, const Imath::V3f& to) const {
  const Imath::V3d start(from);
  return geometry_->occluded({start, Imath::V3d(to) - start, 1.0});
}

bool Scene::occluded(const Ray& ray) const {
  return geometry_->occluded(
      {Imath::V3d(ray.origin), Imath::V3d(ray.direction), static_cast<double>(ray.t_max), ray.time});
}

void Scene::intersect(std::span<const Ray> rays, std::span<std::optional<SurfaceHit>> hits) const {
  geometry_->intersect(rays, hits);
}

void Scene::occluded(std::span<const BasicRay<double>> rays, std::span<std::uint8_t> blocked) const {
  geometry_->occluded(rays, blocked);
}

void Scene::replay(std::span<const LoggedRay> rays) const {
  geometry_->replay(rays);
}

void Scene::measure_working_range() {
  far_threshold_m = working_range_of(camera, shapes).far_threshold;
  bounds.makeEmpty();
  max_rounding_ = 0;
  for (ShapeInstance& instance : shapes) {
    const Imath::Box3d box = abbe::bounds(instance.shape);
    instance.rounding = is_triangulated(instance.shape) ? largest_coordinate(box) : 0;
    instance.distant = distance_to(box, position(camera)) > far_threshold_m;
    if (instance.distant) continue;
    bounds.extendBy(box);
    max_rounding_ = std::max(max_rounding_, instance.rounding);
  }
  if (is_probe(camera) && traits(camera).opening) bounds.extendBy(abbe::bounds(camera));
}

void Scene::measure_media() {
  std::vector<ShapeInstance*> filled;
  for (ShapeInstance& instance : shapes)
    if (encloses_medium(materials[instance.material])) filled.push_back(&instance);
  if (filled.size() < 2) return;
  std::map<const Prototype*, double> of_prototypes;
  for (ShapeInstance* instance : filled) instance->volume = volume_of(instance->shape, of_prototypes);
}

bool Scene::is_distant(const Light& light) const {
  if (const auto surface = surface_of(light)) return shapes[*surface].distant;
  const Imath::V3f* at = light_position(light);
  return at != nullptr && (Imath::V3d(*at) - position(camera)).length() > far_threshold_m;
}

void Scene::commit() {
  measure_working_range();
  measure_media();
  tabulate_in_media(*this);
  background_.clear();
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (lights[i].at_infinity() && !lights[i].is_delta())
      background_.push_back(static_cast<std::uint32_t>(i));
    if (const auto surface = surface_of(lights[i])) shapes[*surface].light = static_cast<std::int32_t>(i);
    measure(lights[i], shapes);
  }
  std::vector<NearWalls> walls = walls_near_shapes(*this);
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    shapes[i].near_wall_bounds = walls[i].box;
    shapes[i].coincidence_bounds.reset();
  }
  geometry_ = std::make_shared<const Geometry>(shapes, materials, std::move(walls));
  features = analyse(*this);
  if (features.nesting || features.boundaries) {
    const std::vector<Imath::Box3f> regions = coincidence_regions(*this);
    for (std::size_t i = 0; i < shapes.size(); ++i) shapes[i].coincidence_bounds = regions[i];
  }
  if (!features.motion) shutter = shutter.static_equivalent();
}

std::size_t Scene::triangle_count() const {
  return geometry_->triangle_count();
}

std::size_t Scene::memory_bytes() const {
  std::size_t bytes = geometry_->memory_bytes() + shapes.size() * sizeof(ShapeInstance);
  std::set<const Curve*> spectra;
  for (const Light& light : lights) {
    bytes += abbe::memory_bytes(light);
    if (spectra.insert(&light.emission.base()).second) bytes += light.emission.base().memory_bytes();
  }
  for (const Material& material : materials) bytes += texture_bytes(material);
  // shapes of one instance are adjacent and share their placement
  const Placement* last_placement = nullptr;
  for (const ShapeInstance& instance : shapes) {
    if (const auto* mesh = std::get_if<Mesh>(&instance.shape)) bytes += abbe::memory_bytes(*mesh);
    const auto* placed = std::get_if<PlacedShape>(&instance.shape);
    if (placed == nullptr || placed->at.get() == last_placement) continue;
    last_placement = placed->at.get();
    bytes += sizeof(Placement);
  }
  return bytes;
}

std::optional<ExactHit> intersect_exact(const Scene& scene, const BasicRay<double>& ray, double t_min) {
  BasicRay<double> rest = ray;
  std::optional<ExactHit> nearest;
  for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
    const std::optional<ShapeHit<double>> hit = intersect(scene.shapes[i].shape, rest, t_min);
    if (!hit) continue;
    rest.t_max = hit->t;
    nearest = ExactHit{*hit, static_cast<std::uint32_t>(i)};
  }
  return nearest;
}

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
