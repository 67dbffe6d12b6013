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
  double facing = 0;   ///< Intensity [m^2], or irradiance at infinity, for a receiver that faces the lights.
  double all_sides = 0;  ///< Intensity [m^2], or irradiance at infinity, for a receiver without orientation.
  bool at_infinity = false;
  bool ambient = false;  ///< True for light that is equal from all directions.
};

/// Bounding box of a light with a position, over its whole motion.
[[nodiscard]] Imath::Box3d bounds_of(const Light& light, const Scene& scene);

/// Bounds of one light with the emission `emission` (`Emissions::sensor_emissions`). An area light has the
/// intensity of its projected area along its axis: constant for a sphere; for a closed mesh, a quarter of its
/// area.
[[nodiscard]] LightBounds light_bounds(const Light& light, const Scene& scene, double emission);
[[nodiscard]] LightBounds union_of(const LightBounds& a, const LightBounds& b);

}  // namespace abbe
