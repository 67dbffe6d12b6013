#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "scene/shapes/shape.h"

namespace abbe {

/// A shape with its material, and its light if it emits.
struct ShapeInstance {
  std::string name;
  Shape shape;
  std::uint32_t material;   ///< Index into `Scene::materials`.
  std::int32_t light = -1;  ///< Index into `Scene::lights`, or -1.
  // Set by `Scene::commit`:
  bool distant = false;  ///< Entirely farther than `Scene::far_threshold_m`.
  double rounding = 0;   ///< Largest absolute coordinate of its float vertices [m]; 0 for curved shapes.
  /// Volume of the enclosed medium [m^3], see `enclosed_volume`; 0 if no other shape encloses a medium.
  double volume = 0;
  /// Region [m] where it transmits light and an opaque surface is within float resolution; empty if there is
  /// none.
  Imath::Box3f near_wall_bounds = {};
  /// Region [m] where another surface may coincide with it, by `coincidence_regions`; empty if there is none.
  /// Nothing if that was not examined, so that a surface may coincide anywhere.
  std::optional<Imath::Box3f> coincidence_bounds = {};
};

}  // namespace abbe
