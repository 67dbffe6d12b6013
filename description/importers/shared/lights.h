#pragma once

#include <utility>

#include "description/importers/shared/scene_importer.h"

namespace abbe::importers {

/// Adds a light to the importer's scene.
template <typename LightSpec>
void append_light(LightSpec light_spec, const SourcePosition& where, SceneImporter& importer) {
  importer.reserve_values(kValuesPerItem);
  spec::Light light;
  light.kind = std::move(light_spec);
  light.where = where;
  importer.scene.lights.push_back(std::move(light));
}

/// Falloff of a spot's intensity between an inner and an outer angle from its axis:
/// - smooth_cosine: 3t^2 - 2t^3;
/// - squared_cosine: t^2, with t = (cos a - cos outer)/(cos inner - cos outer);
/// - linear_angle: linear in the angle.
enum class Falloff { smooth_cosine, squared_cosine, linear_angle };

/// Half angle [degrees] of a cone with a hard edge and the same flux as a spot with full intensity up to
/// `inner_deg` and none from `outer_deg` on. Noted if the angles differ.
[[nodiscard]] double hard_cone(double inner_deg, double outer_deg, Falloff falloff,
                               const SourcePosition& where, SceneImporter& importer);

}  // namespace abbe::importers
