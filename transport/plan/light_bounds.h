#pragma once

#include <ImathBox.h>

#include "scene/scene.h"
#include "transport/plan/emission_cone.h"

namespace abbe {

/// Bounds on position and strength of one light, or of several that are all nearby or all at infinity.
struct LightBounds {
  Imath::Box3d box;    ///< Bounding box of the lights [m]; at infinity, of the unit vectors towards them.
  double radius = 0;   ///< Radius of a sphere around the box's center that contains the lights [m].
  double nearest = 0;  ///< Distance [m] from the center below which the irradiance is taken as constant.
  EmissionCone cone;   ///< Cone of emission; at infinity, of the directions towards the lights.
  /// Intensity, or irradiance at infinity, for a receiver that faces the lights: emission times area [m^2] or
  /// solid angle [sr], or the emission itself of a delta light.
  double facing = 0;
  double all_sides = 0;  ///< Quantity of `facing` for a receiver without orientation.
  bool at_infinity = false;
  bool ambient = false;  ///< True for light that is equal from all directions.
};

/// World-space bounding box [m] of a light over its whole motion. The light must not be at infinity.
[[nodiscard]] Imath::Box3d bounds_of(const Light& light, const Scene& scene);

/// Bounds of one light with the emission `emission` (`Emissions::sensor_emissions`). An area light has the
/// intensity of its projected area along its axis: constant for a sphere; for a closed mesh, a quarter of its
/// area.
[[nodiscard]] LightBounds light_bounds(const Light& light, const Scene& scene, double emission);
/// Bounds of all lights of both, which must be nearby in both or at infinity in both. The result is not
/// ambient.
[[nodiscard]] LightBounds union_of(const LightBounds& a, const LightBounds& b);

}  // namespace abbe
