#pragma once

#include <vector>

#include <ImathMatrix.h>

#include "description/doors/pbrt/world.h"

namespace abbe::doors::pbrt {

/// What a surface of an area light sends out. A light's "power" is that of each face, given by its area
/// [m^2]: of faces of several areas it is spread evenly over all, which is noted, as they are not equally
/// bright there.
[[nodiscard]] spec::Emission area_emission(const Made& light, const std::vector<double>& faces, World& world);

/// Adds a light that is no surface. Reports an unknown type; notes what has no counterpart.
void add_light(const Made& light, const Imath::M44d& to_world, World& world);

}  // namespace abbe::doors::pbrt
