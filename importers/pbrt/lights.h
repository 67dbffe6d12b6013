#pragma once

#include <vector>

#include <ImathMatrix.h>

#include "importers/pbrt/import_state.h"

namespace abbe::importers::pbrt {

// Errors go to `state.importer.diagnostics`; approximations and losses go to `SceneImporter::note`. Functions
// throw Error{resource} if the memory limit of `state.importer.inputs` is exceeded.

/// The emission of a surface with the area light `light`: its luminance, or its luminous flux if the light
/// has a "power". `faces` are the areas of its faces in one unit. pbrt's "power" is that of each face. If
/// their areas differ, the total is spread evenly, which is noted: in pbrt such faces differ in radiance.
/// Reports any other type than "diffuse".
[[nodiscard]] spec::Emission area_emission(const Directive& light, const std::vector<double>& faces,
                                           ImportState& state);

/// Adds a LightSource to `state.importer.scene.lights`. `to_world` leads from its coordinates to those of the
/// written scene. A type of pbrt without a counterpart in Abbe is noted and dropped. Reports an unknown type
/// and unreadable images; notes parameters that Abbe cannot represent.
void add_light(const Directive& light, const Imath::M44d& to_world, ImportState& state);

}  // namespace abbe::importers::pbrt
