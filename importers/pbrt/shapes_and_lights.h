#pragma once

#include <optional>
#include <vector>

#include <ImathMatrix.h>

#include "importers/pbrt/materials.h"
#include "importers/pbrt/spectra.h"
#include "importers/shared/placement.h"

namespace abbe::importers::pbrt {

// Errors go to `state.importer.diagnostics`; approximations and losses go to `SceneImporter::note`. Functions
// throw Error{resource} if the memory limit of `state.importer.inputs` is exceeded.

/// A shape directive with its graphics state.
struct ShapeUse {
  Directive directive;
  Imath::M44d to_world;               ///< Matrix for row vectors to the written scene or the object.
  bool reversed = false;              ///< True if ReverseOrientation applies.
  std::string material;               ///< Name of a material of the written scene.
  std::optional<Directive> emission;  ///< Its area light; nothing if it does not emit.
};

/// Adds a shape to `shapes`, which belongs to an owner of the kind `owner`. Some shapes become an object and
/// an instance instead; see `append_shape`. Reports unknown types, missing parameters and missing files to
/// `state.importer.diagnostics`; such a shape is left out. Types of pbrt without a counterpart, emission
/// inside objects and unsupported parameters are noted and dropped.
void add_shape(const ShapeUse& use, ShapeOwner owner, std::vector<spec::Shape>& shapes, ImportState& state);

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
