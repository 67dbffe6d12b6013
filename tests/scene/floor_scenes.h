#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "scene/lost_light.h"
#include "scene/shapes/shape.h"
#include "scenes.h"

namespace abbe::test {

inline constexpr std::uint32_t kDiffuse = 0;
inline constexpr std::uint32_t kMirror = 1;
inline constexpr std::uint32_t kGlass = 2;

/// A diffuse floor viewed by a pinhole; the tests add to it.
inline Scene floor_scene() {
  Scene scene{};
  scene.camera = pinhole();
  scene.materials = {diffuse(), mirror(), glass()};
  scene.shapes.push_back({"floor", Quad{{-5, -5, 0}, {10, 0, 0}, {0, 10, 0}}, kDiffuse});
  scene.channels.push_back(energy_channel("Y", Curve(1.0)));
  return scene;
}
inline void add_bulb(Scene& scene) {
  scene.lights.push_back({"bulb", PointLight{{0, 0, 3}}, Curve(1.0)});
}
inline void add_lamp(Scene& scene, double size) {
  scene.lights.push_back(
      {"lamp", AreaLight{static_cast<std::uint32_t>(scene.shapes.size()), false}, Curve(1.0)});
  scene.shapes.push_back({"lamp", Quad{{0, 0, 3}, {0, size, 0}, {size, 0, 0}}, kDiffuse});
}
inline void add_sky(Scene& scene) {
  scene.lights.push_back({"sky", EnvironmentLight{}, Curve(1.0)});
}
inline void add_ball(Scene& scene, std::uint32_t material) {
  scene.shapes.push_back({"ball", Sphere{{0, 0, 1}, 0.5}, material});
}

inline Shape placed(PlainShape shape, const Imath::M44d& at) {
  return PlacedShape{make_prototype(std::move(shape)), std::make_shared<Placement>(placement(at))};
}

inline std::vector<std::string> unreached_expressions(const Scene& scene, bool light_tracing) {
  std::vector<std::string> expressions;
  for (const PathClass& path : unsampled_paths(scene, scene.features, light_tracing))
    expressions.push_back(path.substr(0, path.find(':')));
  return expressions;
}
using Expressions = std::vector<std::string>;

}  // namespace abbe::test
