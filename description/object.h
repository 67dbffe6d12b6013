#pragma once

#include <string>
#include <vector>

#include "description/load_context.h"
#include "description/transform.h"
#include "scene/scene.h"

namespace abbe::spec {

struct Instance {
  schema::Located<std::string> of;
  schema::Located<std::vector<Affine>> transform;
};
[[nodiscard]] const schema::Fields& fields(schema::Tag<Instance>);

}  // namespace abbe::spec

namespace abbe::description {

void read_objects(const JsonValue& json, LoadContext& context, Scene& scene);
/// The shapes of an object, placed.
void add_instance(const JsonValue& json, const std::string& name, LoadContext& context, Scene& scene);

}  // namespace abbe::description
