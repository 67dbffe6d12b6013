#include "description/object.h"

#include <utility>

#include <fmt/format.h>

#include "description/shape.h"
#include "description/transform.h"
#include "description/values.h"
#include "io/schema/read.h"
#include "scene/shapes/placed.h"

namespace abbe::spec {

const schema::Fields& fields(schema::Tag<Instance>) {
  static const schema::Fields kFields =
      schema::describe<Instance>("instance", "An object placed in the scene.",
                                 {schema::field("of", &Instance::of, schema::text(), "Name of the object."),
                                  schema::field("transform", &Instance::transform, affine_steps(),
                                                "Where it is placed, by steps in order.")
                                      .or_default()});
  return kFields;
}

}  // namespace abbe::spec

namespace abbe::description {
namespace {

void read_object_shape(const JsonValue& json, std::size_t number, LoadContext& context, Scene& scene,
                       std::vector<NamedShape>& parts) {
  ObjectReader reader(json, context.diagnostics);
  const std::string name = reader.string("name").value_or(fmt::format("shape {}", number));
  if (const JsonValue* instance = json.find("instance")) {
    context.diagnostics.error(instance->where, "an object holds shapes, not instances");
    return;
  }
  if (const JsonValue* emission = reader.find("emission"))
    context.diagnostics.error(emission->where, "a shape of an object cannot emit");
  const auto key = reader.exactly_one({"mesh", "sphere", "disc", "quad", "prism"});
  if (!key) return;
  for (NamedShape& part : read_named_shapes(reader, *key, name, context, scene))
    parts.push_back(std::move(part));
  reader.finish();
}

// Around the middle of the object, where floats are finest.
Object centred(std::vector<NamedShape> parts) {
  Imath::Box3d box;
  for (const NamedShape& part : parts)
    std::visit([&](const auto& shape) { box.extendBy(bounds(shape)); }, part.shape);
  Object object{{}, box.isEmpty() ? Imath::V3d(0) : box.center()};
  for (NamedShape& part : parts) {
    std::visit([&](auto& shape) { shift(shape, -object.center); }, part.shape);
    object.parts.push_back({std::move(part.name), part.material, make_prototype(std::move(part.shape))});
  }
  return object;
}

}  // namespace

void read_objects(const JsonValue& json, LoadContext& context, Scene& scene) {
  const auto* members = std::get_if<JsonValue::Object>(&json.value);
  if (!members) {
    context.diagnostics.error(json.where,
                              fmt::format("expected an object of objects by name (got {})", json.kind()));
    return;
  }
  for (const auto& [name, value] : *members) {
    ObjectReader reader(value, context.diagnostics);
    const JsonValue* list = reader.require("shapes");
    reader.finish();
    std::vector<NamedShape> parts;
    const JsonValue::Array* shapes = list ? read_array(*list, "shapes", 1, context.diagnostics) : nullptr;
    for (std::size_t i = 0; shapes && i < shapes->size(); ++i)
      read_object_shape((*shapes)[i], i, context, scene, parts);
    context.objects.emplace(name, centred(std::move(parts)));
  }
}

void add_instance(const JsonValue& json, const std::string& name, LoadContext& context, Scene& scene) {
  const auto instance = schema::read<spec::Instance>(json, context.diagnostics);
  if (!instance) return;
  const auto matrix = build(instance->transform.value, instance->transform.where, context);
  if (!matrix) return;
  const auto found = context.objects.find(instance->of.value);
  if (found == context.objects.end()) {
    std::vector<std::string> names;
    for (const auto& [known, object] : context.objects) names.push_back(known);
    context.diagnostics.error(instance->of.where, unknown_name("object", instance->of.value, names));
    return;
  }
  const Object& object = found->second;
  const auto at =
      std::make_shared<Placement>(placement(Imath::M44d().setTranslation(object.center) * *matrix));
  context.placements.push_back(at);
  for (const Object::Member& member : object.parts)
    scene.shapes.push_back({object.parts.size() == 1 ? name : name + "/" + member.name,
                            PlacedShape{member.prototype, at}, member.material});
}

}  // namespace abbe::description
