#pragma once

#include "scene/lights/light.h"

namespace abbe {

/// How densely light leaves a light by itself, which is how photons start where nothing aims them.
struct EmissionDensity {
  /// Of the point [1/m^2]; 1 of a light that is a point. Of light from infinity, of where its way crosses the
  /// disc of the scene's radius that faces it.
  float pdf_position;
  /// Of the direction from there [1/sr]; 1 of a beam, which has a single one, and 0 where no light goes.
  float pdf_direction;
};

/// The density of light that leaves in the unit direction `wo`, from a point of an area light whose outward
/// normal is `normal`: uniform by area and by the cosine on the side or sides that emit, uniform in the
/// directions of point and spot lights, and from infinity as `sample_light` draws it. All at that time.
[[nodiscard]] EmissionDensity emission_density(const Light& light, const Imath::V3f& normal,
                                               const Imath::V3f& wo, float scene_radius_m, float time);

/// A direction of that density, by `u` in [0, 1)^2, of a light that has a place; Error{internal} of others.
[[nodiscard]] Imath::V3f emission_direction(const Light& light, const Imath::V3f& normal, Imath::V2f u,
                                            float time);

}  // namespace abbe
