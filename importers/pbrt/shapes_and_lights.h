#pragma once

#include <optional>
#include <vector>

#include <ImathMatrix.h>

#include "importers/pbrt/materials.h"
#include "importers/pbrt/spectra.h"
#include "importers/shared/placement.h"

namespace abbe::importers::pbrt {

/// Adds the shape of a directive to `shapes`, which belongs to an owner of the kind `owner`. `shape` has its
/// matrix, material and orientation, `light` is its area light. Some shapes become an object and an instance
/// instead; see `append_shape`. Reports unknown types, missing parameters and missing files; such a shape is
/// left out. Types of pbrt without a counterpart, emission inside objects and unsupported parameters are
/// noted and dropped.
void add_shape(const Directive& directive, const std::optional<Directive>& light, ImportedShape shape,
               ShapeOwner owner, std::vector<spec::Shape>& shapes, ImportState& state);

/// Adds a LightSource to the scene. `to_world` leads from its coordinates to those of the written scene. A
/// type of pbrt without a counterpart in Abbe is noted and dropped. Reports an unknown type and unreadable
/// images.
void add_light(const Directive& light, const Imath::M44d& to_world, ImportState& state);

}  // namespace abbe::importers::pbrt
