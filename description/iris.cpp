#include "description/iris.h"

#include "description/value_ranges.h"

namespace abbe::spec {

using namespace schema;

Fields fields(Tag<Iris>) {
  return describe(
      "iris", "The blades of a stop.",
      {field("blades", &Iris::blades, {lens::kMinBlades, lens::kMaxBlades},
             "Number of straight blades. The opening is the regular polygon inscribed in the circle of the "
             "stop; the f-number stays that of the circle. Round if absent."),
       field("blade_rotation_deg", &Iris::blade_rotation_deg, kAngle,
             "Rotation of the blades, clockwise as seen by the camera; if absent, a corner points up.")});
}

}  // namespace abbe::spec

namespace abbe::description {

std::optional<lens::Iris> build(const spec::Iris& iris, const LoadContext& context) {
  const auto& rotation = iris.blade_rotation_deg;
  if (iris.blades) return lens::Iris(*iris.blades, rotation ? rotation->value : 0);
  if (rotation)
    context.diagnostics.warning(rotation->where,
                                "blade_rotation_deg has no effect: the stop has no blades and is round");
  return std::nullopt;
}

}  // namespace abbe::description
