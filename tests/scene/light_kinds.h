#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scenes.h"

namespace abbe::test {

/// A light of each kind and with each possible shape, alone in a committed scene around the origin.
struct LightKind {
  std::string name;
  Scene scene;

  [[nodiscard]] const Light& light() const { return scene.lights[0]; }
};

inline Scene lit_by(decltype(Light::kind) kind) {
  Scene scene{};
  scene.camera = pinhole();
  scene.materials = {diffuse()};
  scene.shapes.push_back({"card", Quad{{-1, -1, 0}, {2, 0, 0}, {0, 2, 0}}, 0});
  scene.lights.push_back({"light", std::move(kind), Curve(1.0)});
  scene.commit();
  return scene;
}

[[nodiscard]] inline std::vector<LightKind> all_light_kinds() {
  const Mesh corner{{{0, 0, 1}, {1, 0, 1}, {1, 1, 1.5}, {0, 1, 1}}, {{0, 3, 2}, {0, 2, 1}}};
  std::vector<LightKind> kinds{
      {"rectangle", lit_by(Shape(Quad{{-0.5, -0.5, 2}, {0, 1, 0}, {1, 0, 0}}))},
      {"wide rectangle", lit_by(Shape(Quad{{-2, -2, 0.7}, {0, 4, 0}, {4, 0, 0}}))},
      {"parallelogram", lit_by(Shape(Quad{{0, 0, 1}, {0.5, 1, 0}, {1, 0, 0}}), true)},
      {"mesh", lit_by(Shape(corner))},
      {"disc", lit_by(Shape(Disc{{0.2, 0, 1}, Imath::V3d(0.3, 0, -1).normalized(), 0.8}))},
      {"sphere", lit_by(Shape(Sphere{{0, 0.3, 3}, 1}))},
      {"point", lit_by(PointLight{{0.1F, 0.2F, 1}})},
      {"spot", lit_by(SpotLight{{0.1F, 0.2F, 1}, {0, 0, -1}, 0.4F})},
      {"photometric",
       lit_by(PhotometricLight{{0.1F, 0.2F, 1},
                               {0, 0, 1},
                               {1, 0, 0},
                               std::make_shared<const IntensityDistribution>(IntensityDistribution::Table{
                                   {0, 60, 120, 180}, {0, 360}, {1, 2, 1, 0.5, 1, 2, 1, 0.5}})})},
      {"environment", lit_by(EnvironmentLight{})},
      {"directional", lit_by(DirectionalLight{{0, 0.6F, 0.8F}})},
      {"sun", lit_by(SunLight{{0, 0.6F, 0.8F}, 0.02F})}};
  return kinds;
}

}  // namespace abbe::test
