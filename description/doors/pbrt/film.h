#pragma once

#include <optional>

#include "description/doors/pbrt/world.h"

namespace abbe::doors::pbrt {

/// What a scene says of its picture before its world begins.
struct Picture {
  std::optional<Made> camera{};
  Imath::M44d camera_to_world{};
  std::string camera_medium{};
  std::optional<Made> film{};
  std::optional<Made> sampler{};
  std::optional<Made> integrator{};
  std::optional<Made> filter{};
};

/// Sets camera, pbrt's own without one, sensor, render and output of the scene, and what turns the world
/// upright. `end` is where what is missing would stand.
void set_picture(const Picture& picture, const SourcePosition& end, World& world);

}  // namespace abbe::doors::pbrt
