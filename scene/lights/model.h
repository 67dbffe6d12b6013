#pragma once

#include <concepts>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include <ImathBox.h>
#include <ImathVec.h>

#include "scene/shapes/motion.h"
#include "scene/shapes/ray.h"
#include "scene/shapes/shape.h"

// The interface of the light models, which `LightModel` states. `Light` holds one of them; the functions of
// scene/lights/light.h answer for any light.
namespace abbe {

using Shapes = std::vector<ShapeInstance>;

/// The point for which light is sampled. `side` is the unit normal of the side of a surface that receives the
/// light, if it receives it from one side only.
struct LightSampleContext {
  Imath::V3f point{0, 0, 0};  ///< Render coordinates [m].
  std::optional<Imath::V3f> side = {};
  bool glossy = false;  ///< True if the BSDF has glossy lobes, which sample environment light better.
};

/// Arguments of `sample_light` but the light.
struct LightQuery {
  const Shapes& shapes;
  const LightSampleContext& context;
  Imath::V2f u;
  float time;
};

/// A sampled direction towards a light. `factor` times `emission_from` is the incident radiance (area,
/// environment, sun) or the irradiance of a perpendicular surface (delta lights). Visibility is not tested.
struct LightSample {
  Imath::V3f wi;   ///< Unit direction from the point towards the light.
  float distance;  ///< [m]; infinite for lights at infinity.
  float factor;  ///< `emission_factor` over the squared distance [1/m^2] for lights at a point, otherwise 1.
  float pdf;     ///< Density of `wi` [1/sr]; 1 for delta lights.
  /// End of the shadow ray: the point of the light, offset from its surface. Undefined for lights at
  /// infinity.
  Imath::V3f end;
  Imath::V3f normal{0, 0, 0};  ///< Outward unit normal of an area light there; zero for the others.
};

/// Light that arrives at a point from the unit direction `wi`, of a light hit at `hit` with that outward unit
/// normal, at some time. For lights at infinity the hit is undefined.
struct LightHit {
  const LightSampleContext& context;
  const Imath::V3f& wi;
  const Imath::V3f& hit;
  const Imath::V3f& normal;
  float time;
};

/// A starting point of photons: position and outward normal on an area light, or the position of a light at a
/// point with a zero normal.
struct EmissionPoint {
  Imath::V3f point;
  Imath::V3f normal;
  float pdf_area;  ///< Density by area [1/m^2]; 1 for lights at a point.
};

/// Arguments of `emission_density` but the light.
struct EmissionQuery {
  const Imath::V3f& normal;
  const Imath::V3f& wo;
  float scene_radius_m;
  float time;
};
/// Densities with which a light emits photons without a photon guide.
struct EmissionDensity {
  /// Density of the point [1/m^2]; 1 for a point. For light from infinity, the density on the disc of the
  /// scene's radius that is perpendicular to the direction.
  float pdf_position;
  /// Density of the propagation direction there [1/sr]; 1 for a directional light, 0 where the light does not
  /// emit.
  float pdf_direction;
};

/// Directions within an angle of a unit axis; `cap` is 1 - cos of that angle, in [0, 2], which is precise for
/// narrow cones.
struct DirectionCone {
  Imath::V3f axis;
  float cap;
};
/// Density [1/sr] of directions uniform in a cone of that cap, which is greater than 0.
[[nodiscard]] inline float cone_pdf(float cap) {
  return 1 / (2 * std::numbers::pi_v<float> * cap);
}

/// Bound on the directions of lights' emission: full emission within the angle `spread` around the unit
/// `axis`, a cosine falloff of the excess angle outside, and none above the excess `falloff`. Both angles are
/// in radians, in [0, pi].
struct EmissionCone {
  Imath::V3d axis{0, 0, 1};
  double spread = 0;
  double falloff = 0;
};
inline constexpr EmissionCone kEverywhere{{0, 0, 1}, std::numbers::pi, 0};

/// Bounds on position and strength of one light, or of several that are all nearby or all at infinity.
struct LightBounds {
  Imath::Box3d box;    ///< Bounding box of the lights [m]; at infinity, of the unit vectors towards them.
  double radius = 0;   ///< Radius of a sphere around the box's center that contains the lights [m].
  double nearest = 0;  ///< Distance [m] from the center below which the irradiance is taken as constant.
  EmissionCone cone;   ///< Cone of emission; at infinity, of the directions towards the lights.
  /// Intensity, or irradiance at infinity, for a receiver that faces the lights: emission times area [m^2] or
  /// solid angle [sr], or the emission itself of a delta light.
  double facing = 0;
  double all_sides = 0;  ///< Quantity of `facing` for a receiver without orientation.
  bool at_infinity = false;
  bool ambient = false;  ///< True for light that is equal from all directions.
};

/// A light at a point, which may move.
template <typename Model>
concept PointLightModel = requires(const Model& light) {
  /// Render coordinates [m]; at time 0 if it moves.
  { light.position } -> std::convertible_to<const Imath::V3f&>;
  /// Null if it does not move.
  { light.motion } -> std::convertible_to<const std::shared_ptr<const Motion>&>;
};

/// Requirements on a model of light. Times are fractions of the exposure; random numbers `u` are in [0, 1)^2;
/// `wo` is a unit propagation direction away from the light, `wi` one towards it.
///
/// A model may also have the following functions. Without one, the value in brackets holds.
/// - `emission_factor(normal, wo, time)`, `emits_towards(normal, wo)`: as in light.h [1, true].
/// - `emission_from(emission, wi, wavelengths_nm)`, `mean_emission(emission)`: as in light.h, from the
/// spectrum `Light::emission` [that spectrum].
/// - `cone_at(time)`: the cone that contains all emission of a light at a point [none].
/// - `beam()`: the cone of directions towards a light at infinity that is to be aimed at a target [none].
/// - `is_visible_along(wi)`: true if that direction points to a light at infinity [true].
/// - `solid_angle()`: solid angle [sr] of a light without a shape [0].
/// - `central_ray(sphere)`, `fan()`: see light.h [none, 60 degrees].
/// - `measure(shapes)`: as in light.h [nothing to do].
/// - `memory_bytes()`: memory of its own data, in addition to the size of the struct [0].
template <typename Model>
concept LightModel = requires(const Model& light, const Shapes& shapes, const LightQuery& query,
                              const EmissionQuery& emission) {
  /// True if it arrives from a single direction at every point, so that BSDF sampling cannot hit it.
  { Model::kIsDelta } -> std::convertible_to<bool>;
  /// True if it has no position.
  { Model::kAtInfinity } -> std::convertible_to<bool>;
  /// `sample_light` for this model.
  { light.sample(query) } -> std::same_as<std::optional<LightSample>>;
  /// The function of the same name in light.h.
  { light.emission_density(emission) } -> std::same_as<EmissionDensity>;
  /// Factor from the mean emission to the power, as `etendue` in light.h. The argument is the cross-section
  /// [m^2] of the scene, which only lights at infinity use.
  { light.etendue(1.0) } -> std::same_as<double>;
  /// `light_bounds` for this model.
  { light.bounds(shapes, 1.0) } -> std::same_as<LightBounds>;
}
&&(Model::kIsDelta ||
   requires(const Model& light, const Shapes& shapes, const LightHit& at) {
     /// `light_pdf` for this model, where it emits towards the point.
     { light.pdf(shapes, at) } -> std::same_as<float>;
   }) &&
    (Model::kAtInfinity ||
     requires(const Model& light, const Imath::V3f& normal, Imath::V2f u, float time) {
       /// The function of the same name in light.h.
       { light.emission_direction(normal, u, time) } -> std::same_as<Imath::V3f>;
     }) &&
    (Model::kAtInfinity || PointLightModel<Model> ||
     requires(const Model& light, const Shapes& shapes, Imath::V2f u, float time) {
       /// The functions of the same names in light.h.
       { light.sample_emission_point(shapes, u, time) } -> std::same_as<EmissionPoint>;
       { light.box(shapes) } -> std::same_as<Imath::Box3d>;
       { light.motion_in(shapes) } -> std::same_as<const Motion*>;
     });

}  // namespace abbe
