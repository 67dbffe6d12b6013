#pragma once

#include <string>

#include "description/load_context.h"
#include "scene/scene.h"

namespace abbe::description {

void read_objects(const JsonValue& json, LoadContext& context, Scene& scene);
/// The shapes of an object, placed.
void add_instance(const JsonValue& json, const std::string& name, LoadContext& context, Scene& scene);

}  // namespace abbe::description
