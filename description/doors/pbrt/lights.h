#pragma once

#include <ImathMatrix.h>

#include "description/doors/pbrt/world.h"

namespace abbe::doors::pbrt {

/// What a surface of an area light sends out.
[[nodiscard]] spec::Emission area_emission(const Made& light, World& world);

/// Adds a light that is no surface. Reports an unknown type; notes what has no counterpart.
void add_light(const Made& light, const Imath::M44d& to_world, World& world);

}  // namespace abbe::doors::pbrt
