#pragma once

#include "scene/lights/light.h"

namespace abbe {

/// Densities with which a light emits photons without a photon guide.
struct EmissionDensity {
  /// Density of the point [1/m^2]; 1 for a point. For light from infinity, the density on the disc of the
  /// scene's radius that is perpendicular to the direction.
  float pdf_position;
  /// Density of the propagation direction there [1/sr]; 1 for a directional light, 0 where the light does not
  /// emit.
  float pdf_direction;
};

/// Density of emission in the unit propagation direction `wo`, away from the light, at that time, a fraction
/// of the exposure. For area lights `normal` is the outward unit normal at the point. They emit uniformly
/// over area and in proportion to the cosine on the emitting sides. Point and spot lights emit uniformly in
/// direction, lights at infinity as `sample_light` samples them without a receiving side. `normal` has no
/// effect on those, and `scene_radius_m` [m] only on lights at infinity.
[[nodiscard]] EmissionDensity emission_density(const Light& light, const Imath::V3f& normal,
                                               const Imath::V3f& wo, float scene_radius_m, float time);

/// Samples a unit propagation direction with that density by `u` in [0, 1)^2, for lights with a position.
/// Throws Error{internal} for lights at infinity.
[[nodiscard]] Imath::V3f emission_direction(const Light& light, const Imath::V3f& normal, Imath::V2f u,
                                            float time);

}  // namespace abbe
