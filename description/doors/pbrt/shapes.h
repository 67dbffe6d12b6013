#pragma once

#include <optional>
#include <vector>

#include "description/doors/pbrt/materials.h"
#include "description/doors/shared/placement.h"

namespace abbe::doors::pbrt {

/// A shape under the attributes of its place in the file.
struct ShapeUse {
  Made made;
  Imath::M44d to_world;  ///< Of the scene to be written, or to its object.
  bool reversed = false;
  std::string material;
  std::optional<Made> emission;
};

/// Adds a shape. Reports an unknown type, parameters that are missing, and files that are; notes what has no
/// counterpart.
void add_shape(const ShapeUse& use, Among among, std::vector<spec::Shape>& shapes, World& world);

}  // namespace abbe::doors::pbrt
