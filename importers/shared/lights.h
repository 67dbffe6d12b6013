#pragma once

#include <utility>

#include "importers/shared/scene_importer.h"

namespace abbe::importers {

/// Adds a light to `importer.scene.lights`. `light_spec` is an alternative of `spec::Light::kind`. Throws
/// Error{resource} if the memory limit of `importer.inputs` is exceeded.
template <typename LightSpec>
void append_light(LightSpec light_spec, const SourcePosition& where, SceneImporter& importer) {
  importer.reserve_values(kValuesPerItem);
  spec::Light light;
  light.kind = std::move(light_spec);
  light.where = where;
  importer.scene.lights.push_back(std::move(light));
}

/// Falloff of a spot's intensity from 1 at an inner angle to 0 at an outer angle from its axis. At the angle
/// a between them, let t = (cos a - cos outer)/(cos inner - cos outer). The intensity is
/// - smooth_cosine: 3t^2 - 2t^3;
/// - squared_cosine: t^2;
/// - linear_angle: (outer - a)/(outer - inner).
enum class Falloff { smooth_cosine, squared_cosine, linear_angle };

/// Half angle [degrees] of a cone with a hard edge and the same flux as a spot of the same axial intensity.
/// The spot has full intensity up to `inner_deg` and none from `outer_deg` on. The replacement is noted at
/// `where`. Returns `outer_deg`, without a note, if `inner_deg` is not smaller.
[[nodiscard]] double hard_cone(double inner_deg, double outer_deg, Falloff falloff,
                               const SourcePosition& where, SceneImporter& importer);

}  // namespace abbe::importers
