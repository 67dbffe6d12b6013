#pragma once

#include <optional>
#include <vector>

#include "importers/pbrt/materials.h"
#include "importers/shared/placement.h"

namespace abbe::importers::pbrt {

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
/// inside objects and unsupported parameters are noted and dropped. Throws Error{resource} if the memory
/// limit of `state.importer.inputs` is exceeded.
void add_shape(const ShapeUse& use, ShapeOwner owner, std::vector<spec::Shape>& shapes, ImportState& state);

}  // namespace abbe::importers::pbrt
