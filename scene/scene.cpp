#include "scene/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "scene/geometry.h"
#include "scene/shapes/mesh.h"

namespace abbe {
namespace {

// Of the images a material looks up.
std::size_t texture_bytes(const Material& material) {
  std::size_t bytes = 0;
  if (material.relief)
    bytes += std::visit([](const auto& map) { return map.image.memory_bytes(); }, *material.relief);
  std::visit(
      [&bytes](const auto& model) {
        if constexpr (requires { model.reflectance.memory_bytes(); })
          bytes += model.reflectance.memory_bytes();
      },
      material.model);
  return bytes;
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

TouchingSurfaces Scene::touching(const Ray& ray, const SurfaceHit& hit) const {
  return geometry_->touching(ray, hit, touch_distance());
}

// Vertices are off the plane they belong to by up to a float step, a point spawned on a surface is up to six
// from it: what is nearer than these is met together, what is further by the ray that leaves.
float Scene::touch_distance() const {
  if (bounds.isEmpty()) return 0;
  double largest = 0;
  for (int i = 0; i < 3; ++i) largest = std::max({largest, std::abs(bounds.min[i]), std::abs(bounds.max[i])});
  return 6 * std::numeric_limits<float>::epsilon() * static_cast<float>(largest);
}

bool Scene::occluded(const Imath::V3f& from, const Imath::V3f& to) const {
  const Imath::V3d start(from);
  return geometry_->occluded({start, Imath::V3d(to) - start, 1.0});
}

bool Scene::occluded(const Ray& ray) const {
  return geometry_->occluded(
      {Imath::V3d(ray.origin), Imath::V3d(ray.direction), static_cast<double>(ray.t_max)});
}

void Scene::replay(std::span<const LoggedRay> rays) const {
  geometry_->replay(rays);
}

void Scene::commit() {
  bounds.makeEmpty();
  for (const ShapeInstance& instance : shapes) bounds.extendBy(abbe::bounds(instance.shape));
  environment_ = -1;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (lights[i].is_environment()) environment_ = static_cast<std::int32_t>(i);
    auto* emitter = std::get_if<AreaLight>(&lights[i].kind);
    if (emitter == nullptr) continue;
    ShapeInstance& instance = shapes[emitter->shape];
    instance.light = static_cast<std::int32_t>(i);
    emitter->measure(instance.shape);
  }
  geometry_ = std::make_shared<const Geometry>(shapes, materials);
  needs = analyse(*this);
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
  const Placement* last = nullptr;  // the shapes of one instance stand side by side and share theirs
  for (const ShapeInstance& instance : shapes) {
    if (const auto* mesh = std::get_if<Mesh>(&instance.shape)) bytes += abbe::memory_bytes(*mesh);
    const auto* placed = std::get_if<PlacedShape>(&instance.shape);
    if (placed == nullptr || placed->at.get() == last) continue;
    last = placed->at.get();
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

}  // namespace abbe
