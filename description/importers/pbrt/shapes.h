#pragma once

#include <optional>
#include <vector>

#include "description/importers/pbrt/materials.h"
#include "description/importers/shared/placement.h"

namespace abbe::importers::pbrt {

/// A shape directive with its graphics state.
struct ShapeUse {
  Directive directive;
  Imath::M44d to_world;  ///< To the coordinates of the written scene, or of the object.
  bool reversed = false;
  std::string material;
  std::optional<Directive> emission;
};

/// Adds a shape to `shapes`. Reports unknown types, missing parameters and missing files; notes what Abbe
/// cannot represent.
void add_shape(const ShapeUse& use, ShapeOwner owner, std::vector<spec::Shape>& shapes, ImportState& state);

}  // namespace abbe::importers::pbrt
