#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "scene/shapes/shape.h"

namespace abbe {

/// A shape made of a material, perhaps emitting.
struct ShapeInstance {
  std::string name;
  Shape shape;
  std::uint32_t material;
  std::int32_t light = -1;  ///< Index into `Scene::lights`, or -1.
  // Worked out by `Scene::commit`:
  bool far = false;     ///< Wholly beyond `Scene::far_from_m`.
  double rounding = 0;  ///< Largest coordinate of its vertices [m], which are kept in float; 0 of curves.
  double volume = 0;    ///< Of matter [m^3], see `enclosed_volume`; 0 where no other shape holds any.
  Imath::Box3f at_walls = {};  ///< Where it lets light on and anything opaque may be as near as floats tell.
  /// Where another surface may touch it, by `touching_regions`; nothing where that is not looked for.
  std::optional<Imath::Box3f> at_touching = {};
};

}  // namespace abbe
