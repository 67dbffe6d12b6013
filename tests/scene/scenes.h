#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <utility>

#include <ImathVec.h>

#include "scene/scene.h"

namespace abbe::test {

/// Random numbers that are the same on every platform.
class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}

  float uniform() { return static_cast<float>(engine_() >> 8) * 0x1p-24F; }
  double between(double low, double high) { return low + (high - low) * static_cast<double>(uniform()); }
  Imath::V2f pair() {
    const float x = uniform();
    return {x, uniform()};
  }
  Imath::V3d in_cube(double half_size) {
    const double x = between(-half_size, half_size);
    const double y = between(-half_size, half_size);
    return {x, y, between(-half_size, half_size)};
  }
  Imath::V3d direction() {
    const double z = between(-1, 1);
    const double phi = between(0, 2 * std::numbers::pi);
    const double ring = std::sqrt((1 - z) * (1 + z));
    return {ring * std::cos(phi), ring * std::sin(phi), z};
  }

 private:
  std::mt19937 engine_;
};

inline Material diffuse() {
  return {"diffuse", DiffuseMaterial{Curve(0.5)}};
}
inline Material mirror() {
  return {"mirror", ConductorMaterial{"silver", RefractiveIndex(0.1, 4)}};
}
inline Material glass() {
  return {"glass", DielectricMaterial{"glass", RefractiveIndex(1.5)}};
}

/// A pinhole camera at the origin looking along +z.
inline Camera pinhole() {
  return {Pinhole{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 0.05, 0.005}, 4, 4, 0.01};
}

/// A committed scene of shapes with one material.
inline Scene scene_of(std::vector<Shape> shapes) {
  Scene scene{};
  scene.camera = pinhole();
  scene.materials = {diffuse()};
  for (Shape& shape : shapes) scene.shapes.push_back({"shape", std::move(shape), 0});
  scene.commit();
  return scene;
}

/// A committed scene of one emitting shape with radiance 1.
inline Scene lit_by(Shape shape, bool two_sided = false) {
  Scene scene{};
  scene.camera = pinhole();
  scene.materials = {diffuse()};
  scene.shapes.push_back({"lamp", std::move(shape), 0});
  scene.lights.push_back({"lamp", AreaLight{0, two_sided}, Curve(1.0)});
  scene.commit();
  return scene;
}

}  // namespace abbe::test
