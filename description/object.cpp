#include <utility>

#include <fmt/format.h>

#include "description/shape.h"
#include "scene/shapes/shape.h"

namespace abbe::description {
namespace {

void build_object_shape(const spec::Shape& shape, const std::string& name, LoadContext& context, Scene& scene,
                        std::vector<NamedShape>& parts) {
  if (const auto* instance = std::get_if<spec::Instance>(&shape.kind))
    return context.diagnostics.error(instance->where, "an object holds shapes, not instances");
  if (const auto* chart = std::get_if<spec::ChartShape>(&shape.kind))
    return context.diagnostics.error(chart->chart.where, "an object holds shapes, not charts");
  if (const spec::Emission* emission = emission_of(shape))
    context.diagnostics.error(emission->where, "a shape of an object cannot emit");
  if (shape.motion)
    context.diagnostics.error(shape.motion->where, "a shape of an object cannot move, but its instances can");
  for (NamedShape& part : build_parts(shape, name, context, scene)) parts.push_back(std::move(part));
}

// Prototypes of the parts, shifted to the center of the object, where single precision resolves best.
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

void build_objects(const std::vector<schema::Named<spec::Object>>& objects, LoadContext& context,
                   Scene& scene) {
  for (const auto& [name, object, where] : objects) {
    std::vector<NamedShape> parts;
    for (std::size_t i = 0; i < object.shapes.size(); ++i)
      build_object_shape(object.shapes[i], object.shapes[i].name.value_or(fmt::format("shape {}", i)),
                         context, scene, parts);
    context.objects.emplace(name, centred(std::move(parts)));
  }
}

void add_instance(const spec::Instance& instance, const PoseAndMotion& moving, const std::string& name,
                  LoadContext& context, Scene& scene) {
  const auto matrix = build(instance.transform.value, instance.transform.where, context);
  if (!matrix) return;
  const auto found = context.objects.find(instance.of.value);
  if (found == context.objects.end()) {
    std::vector<std::string> names;
    for (const auto& [known, object] : context.objects) names.push_back(known);
    context.diagnostics.error(instance.of.where, unknown_name("object", instance.of.value, names));
    return;
  }
  const Object& object = found->second;
  const auto at = std::make_shared<Placement>(
      placement(Imath::M44d().setTranslation(object.center) * *matrix * moving.pose_at_opening));
  at->motion = moving.motion;
  at->described_origin = object.center;
  context.placements.push_back(at);
  for (const Object::Member& member : object.parts)
    scene.shapes.push_back({object.parts.size() == 1 ? name : name + "/" + member.name,
                            PlacedShape{member.prototype, at}, member.material});
}

}  // namespace abbe::description
