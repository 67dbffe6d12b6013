#pragma once

#include <vector>

#include <ImathMatrix.h>

#include "description/importers/pbrt/import_state.h"

namespace abbe::importers::pbrt {

/// The emission of a surface with an area light. `faces` are the areas of its faces [m^2]. pbrt's "power" is
/// that of each face. If their areas differ, the total is spread evenly, which is noted: in pbrt such faces
/// differ in radiance.
[[nodiscard]] spec::Emission area_emission(const Directive& light, const std::vector<double>& faces,
                                           ImportState& state);

/// Adds a light that is not an area light. Reports an unknown type; notes what Abbe cannot represent.
void add_light(const Directive& light, const Imath::M44d& to_world, ImportState& state);

}  // namespace abbe::importers::pbrt
