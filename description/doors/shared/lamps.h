#pragma once

#include <utility>

#include "description/doors/shared/door.h"

namespace abbe::doors {

/// Adds a light of one kind.
template <typename Lamp>
void add_lamp(Lamp lamp, const SourcePosition& where, Door& door) {
  door.add_values(kValuesOfOne);
  spec::Light light;
  light.kind = std::move(lamp);
  light.where = where;
  door.scene.lights.push_back(std::move(light));
}

/// How a spot's intensity falls between two angles from its axis: by 3t^2 - 2t^3 or t^2 of what the cosine
/// has left to go, or linearly with the angle.
enum class Falloff { smooth_cosine, squared_cosine, linear_angle };

/// Half angle [degrees] of the cone with a hard edge that sends out as much as one whose intensity falls so
/// from full at `full_deg` to none at `whole_deg`; noted unless these are one.
[[nodiscard]] double hard_cone(double full_deg, double whole_deg, Falloff falloff,
                               const SourcePosition& where, Door& door);

}  // namespace abbe::doors
