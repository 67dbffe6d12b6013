#pragma once

#include <string>
#include <vector>

#include "importers/mitsuba/materials.h"
#include "importers/mitsuba/object.h"
#include "importers/shared/placement.h"

namespace abbe::importers::mitsuba {

/// Converts a <shape>:
/// - A shape group becomes an object of `state.importer.scene`.
/// - An instance is added to the shapes of that scene.
/// - Any other shape is added to `shapes`, or becomes an object and an instance; see `append_shape`.
/// - A shape with neither a surface nor a medium nor an emitter is left out.
/// `owner` is the kind of the owner of `shapes`. Reports unknown types, missing files and an instance without
/// one shape group.
void add_shape(const Object& shape, ShapeOwner owner, std::vector<spec::Shape>& shapes, Materials& materials);

/// Adds an <emitter> that is not an area light. A type of Mitsuba without a counterpart in Abbe is noted and
/// dropped. Reports an unknown type, malformed properties and missing files.
void add_light(const Object& light);

}  // namespace abbe::importers::mitsuba
