#pragma once

#include "importers/mitsuba/object.h"

namespace abbe::importers::mitsuba {

// Errors go to `state.importer.diagnostics`; approximations and losses go to `SceneImporter::note`. Functions
// throw Error{resource} if the memory limit of `state.importer.inputs` is exceeded.

/// The emission of a surface with an area light, from its property "radiance". Reports a `light` of any other
/// type than "area".
[[nodiscard]] spec::Emission area_emission(const Object& light, const ImportState& state);

/// Adds an <emitter> that is not an area light to `state.importer.scene.lights`. A type of Mitsuba without a
/// counterpart in Abbe is noted and dropped. Reports an unknown type, malformed properties and missing files;
/// notes properties that Abbe cannot represent.
void add_light(const Object& light, const ImportState& state);

}  // namespace abbe::importers::mitsuba
