#pragma once

#include <utility>

#include "description/doors/shared/door.h"

namespace abbe::doors {

/// Adds a light of one kind.
template <typename Lamp>
void add_lamp(Lamp lamp, const SourcePosition& where, Door& door) {
  spec::Light light;
  light.kind = std::move(lamp);
  light.where = where;
  door.scene.lights.push_back(std::move(light));
}

/// Half angle [degrees] of the cone with a hard edge that sends out as much as one whose intensity falls from
/// full at `full_deg` to none at `whole_deg`, half of it where the cosine is the mean; noted unless these are
/// one.
[[nodiscard]] double hard_cone(double full_deg, double whole_deg, const SourcePosition& where, Door& door);

}  // namespace abbe::doors
