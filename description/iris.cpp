#include "description/iris.h"

#include "description/kinds.h"

namespace abbe::spec {

using namespace schema;

Fields fields(Tag<Iris>) {
  return describe(
      "iris", "The blades of a stop.",
      {field("blades", &Iris::blades, {lens::kLeastBlades, lens::kMostBlades},
             "Straight blades, between which the opening is the regular polygon inscribed in its circle; the "
             "f-number stays that of the circle. Round when absent."),
       field("blade_rotation_deg", &Iris::blade_rotation_deg, kAngle,
             "Turn of the blades, clockwise as the camera looks; a corner is up when absent.")});
}

}  // namespace abbe::spec

namespace abbe::description {

std::optional<lens::Iris> build(const spec::Iris& iris, const LoadContext& context) {
  const auto& rotation = iris.blade_rotation_deg;
  if (iris.blades) return lens::Iris(*iris.blades, rotation ? rotation->value : 0);
  if (rotation)
    context.diagnostics.warning(rotation->where,
                                "a turn of blades without effect: the stop has none, and is round");
  return std::nullopt;
}

}  // namespace abbe::description
