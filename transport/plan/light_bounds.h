#pragma once

#include <ImathBox.h>

#include "scene/scene.h"
#include "transport/plan/emission_cone.h"

namespace abbe {

/// Bounds where light may come from and how much of it: of one light, or of several that are all near or all
/// at infinity.
struct LightBounds {
  Imath::Box3d box;      ///< Around the lamps [m]; at infinity, around the unit vectors to where they are.
  double radius = 0;     ///< Of a sphere around the lamps, its middle that of the box [m].
  double nearest = 0;    ///< Distance [m] of the middle within which they are taken to send no more.
  EmissionCone cone;     ///< Where they emit to; at infinity, the directions they are seen in.
  double facing = 0;     ///< Intensity [m^2], or irradiance at infinity, of what faces the lights.
  double all_sides = 0;  ///< Intensity [m^2], or irradiance at infinity, of what takes light from all sides.
  bool at_infinity = false;
  bool ambient = false;  ///< The same from all directions.
};

/// A box around a light that has a place, of one that moves around all of its places.
[[nodiscard]] Imath::Box3d bounds_of(const Light& light, const Scene& scene);

/// The bounds of one light, `seen` being what stands for its emission. An area light has the intensity of its
/// area seen along its axis: the same from all sides for a sphere; for a mesh, a quarter of its area where it
/// is closed.
[[nodiscard]] LightBounds light_bounds(const Light& light, const Scene& scene, double seen);
[[nodiscard]] LightBounds union_of(const LightBounds& a, const LightBounds& b);

}  // namespace abbe
