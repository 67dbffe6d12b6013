#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <ImathVec.h>

#include "scene/lights/area_light.h"
#include "scene/lights/infinite_light.h"
#include "scene/lights/model.h"
#include "scene/lights/photometric_light.h"
#include "scene/lights/point_light.h"
#include "scene/shapes/basic.h"
#include "scene/shapes/ray.h"
#include "scene/shapes/shape.h"
#include "spectral/curve.h"

namespace abbe {

/// The electric field oscillates along a unit axis of the scene, projected perpendicular to the propagation
/// direction.
struct LinearPolarisation {
  Imath::V3f axis{0, 0, 1};
};
/// The electric field rotates: clockwise as seen by the receiver, who looks towards the source, if
/// right-handed, otherwise counter-clockwise.
struct CircularPolarisation {
  bool right = true;
};

/// Polarisation of all light that a light emits.
struct LightPolarisation {
  float degree = 1;  ///< Degree of polarisation, in [0, 1].
  std::variant<LinearPolarisation, CircularPolarisation> kind;
};

/// Normalised Stokes vector (1, q, u, v), in the frame whose first axis is the unit vector `axis`,
/// perpendicular to the propagation direction. q is 1 for full linear polarisation along `axis`, and v is 1
/// for full right-handed circular polarisation. `docs/reference/physics.md` defines the signs.
struct PolarisationState {
  Imath::V3f axis;
  float q = 0;
  float u = 0;
  float v = 0;
};

/// A light: its model with its position, and its emission spectrum. The emission is
/// - spectral radiance [W m^-2 sr^-1 nm^-1] for an area light, environment light or sun. For an environment
///   image it is the radiance of a texel (1, 1, 1);
/// - spectral intensity [W sr^-1 nm^-1] for a point or spot light, for a photometric one averaged over all
///   directions;
/// - spectral irradiance [W m^-2 nm^-1] of a perpendicular surface for a directional light.
struct Light {
  std::string name;
  std::variant<AreaLight, PointLight, SpotLight, EnvironmentLight, DirectionalLight, SunLight,
               PhotometricLight>
      kind;
  ScaledCurve emission;
  std::optional<LightPolarisation> polarisation = {};  ///< Nothing for unpolarised light.

  /// True if the light is one of these kinds.
  template <typename... Kinds>
  [[nodiscard]] bool is() const {
    return (std::holds_alternative<Kinds>(kind) || ...);
  }
  /// True if it arrives from a single direction at every point, so that BSDF sampling cannot hit it.
  [[nodiscard]] bool is_delta() const;
  [[nodiscard]] bool is_environment() const { return is<EnvironmentLight>(); }
  /// True if it has no position.
  [[nodiscard]] bool at_infinity() const;
};

/// Flags of the alternatives of `Light::kind`, in their order.
template <typename Kinds>
struct LightFlags;
template <typename... Models>
struct LightFlags<std::variant<Models...>> {
  static_assert((LightModel<Models> && ...));
  static constexpr std::array<bool, sizeof...(Models)> kIsDelta{Models::kIsDelta...};
  static constexpr std::array<bool, sizeof...(Models)> kAtInfinity{Models::kAtInfinity...};
};
inline bool Light::is_delta() const {
  return LightFlags<decltype(kind)>::kIsDelta[kind.index()];
}
inline bool Light::at_infinity() const {
  return LightFlags<decltype(kind)>::kAtInfinity[kind.index()];
}

/// Index into `Scene::shapes` of the shape whose surface emits; nothing for other lights.
[[nodiscard]] inline std::optional<std::uint32_t> surface_of(const Light& light) {
  const auto* area = std::get_if<AreaLight>(&light.kind);
  return area != nullptr ? std::optional(area->shape) : std::nullopt;
}
/// True if the light is a surface that emits from both sides.
[[nodiscard]] inline bool two_sided(const Light& light) {
  const auto* area = std::get_if<AreaLight>(&light.kind);
  return area != nullptr && area->two_sided;
}
/// Computes what sampling needs of the shape of an area light; nothing to do for other lights. Throws
/// Error{internal} for a static instance. `Scene::commit` calls it.
void measure(Light& light, const Shapes& shapes);

/// Position of a light at a point, at time 0 if it moves; nullptr for other lights.
[[nodiscard]] const Imath::V3f* light_position(const Light& light);
/// Position [m] of a light at a point at that time, a fraction of the exposure; nothing for other lights.
[[nodiscard]] std::optional<Imath::V3f> position_at(const Light& light, float time);
/// Cone that contains all emission of a light at a point at that time; nothing if it has none.
[[nodiscard]] std::optional<DirectionCone> cone_at(const Light& light, float time);
/// Motion of a light, for an area light that of its shape in `shapes`; nullptr if it does not move.
[[nodiscard]] const Motion* motion_of(const Light& light, const Shapes& shapes);
/// World-space bounding box [m] of a light over its whole motion. The light must not be at infinity.
[[nodiscard]] Imath::Box3d bounds_of(const Light& light, const Shapes& shapes);
/// Bounds of a light whose emission has the magnitude `emission`, such as `Emissions::sensor_emissions`.
[[nodiscard]] LightBounds light_bounds(const Light& light, const Shapes& shapes, double emission);
/// Cone of the directions towards a directional light or sun; nothing for other lights.
[[nodiscard]] std::optional<DirectionCone> beam_of(const Light& light);
/// True if the unit direction `wi` points to a light at infinity that is not a delta light.
[[nodiscard]] bool is_visible_along(const Light& light, const Imath::V3f& wi);
/// Solid angle [sr] that a light without a shape subtends, the same from everywhere; 0 for delta lights.
[[nodiscard]] double solid_angle(const Light& light);

/// Emission at these wavelengths, in the unit of `Light`, of light that arrives from the unit direction `wi`,
/// which points towards the light. Only an environment image depends on the direction. Visibility and
/// `emission_factor` are left out.
[[nodiscard]] SampledSpectrum emission_from(const Light& light, const Imath::V3f& wi,
                                            const SampledSpectrum& wavelengths_nm);
/// Factor from the emission to that along the unit direction `wo`, away from the light, at that time. It is
/// - for an area light the cosine with its outward `normal`, and 0 on the sides that do not emit;
/// - for a spot light 1 within its cone and 0 outside;
/// - for a photometric light its relative intensity;
/// - for all others 1.
[[nodiscard]] float emission_factor(const Light& light, const Imath::V3f& normal, const Imath::V3f& wo,
                                    float time);
/// True if the light emits from a surface point with outward `normal` in the direction `wo`, which points
/// away from the surface. Always true for lights without a surface.
[[nodiscard]] bool emits_towards(const Light& light, const Imath::V3f& normal, const Imath::V3f& wo);

/// Polarisation state of the light's emission along the unit propagation direction `travels`. Nothing for
/// unpolarised lights, and for a linearly polarised one along its own axis.
[[nodiscard]] std::optional<PolarisationState> polarisation_of(const Light& light, const Imath::V3f& travels);

/// Samples a direction from a point towards the light at that time by `u` in [0, 1)^2. Nothing if the sampled
/// point of the light cannot illuminate the point: it emits to the other side, or the point lies outside the
/// cone of a spot light.
[[nodiscard]] std::optional<LightSample> sample_light(const Light& light, const Shapes& shapes,
                                                      const LightSampleContext& context, Imath::V2f u,
                                                      float time);

/// Density [1/sr] with which `sample_light` samples the unit direction `wi` that hits the light at
/// `hit_point` with outward unit normal `hit_normal`. For lights at infinity only `wi` has an effect. 0 for
/// delta lights, and where the light does not emit towards the point.
[[nodiscard]] float light_pdf(const Light& light, const Shapes& shapes, const LightSampleContext& context,
                              const Imath::V3f& wi, const Imath::V3f& hit_point, const Imath::V3f& hit_normal,
                              float time);

/// Samples a starting point of photons at that time, uniformly by area, by `u` in [0, 1)^2. Throws
/// Error{internal} for a light at infinity.
[[nodiscard]] EmissionPoint sample_emission_point(const Light& light, const Shapes& shapes, Imath::V2f u,
                                                  float time);
/// Random numbers for `sample_emission_point`, or fractions for `probe_point`, that represent a whole light
/// or probe. Those of its center come first.
inline constexpr std::array<std::array<float, 2>, 5> kRepresentativePoints{
    {{0.5F, 0.5F}, {0.05F, 0.05F}, {0.95F, 0.05F}, {0.05F, 0.95F}, {0.95F, 0.95F}}};

/// Density of emission in the unit propagation direction `wo`, away from the light, at that time, a fraction
/// of the exposure. For area lights `normal` is the outward unit normal at the point; other lights do not use
/// it. Lights at infinity emit as `sample_light` samples them without a receiving side; only they use
/// `scene_radius_m` [m].
[[nodiscard]] EmissionDensity emission_density(const Light& light, const Imath::V3f& normal,
                                               const Imath::V3f& wo, float scene_radius_m, float time);
/// Samples a unit propagation direction with that density by `u` in [0, 1)^2, for lights with a position.
/// Throws Error{internal} for lights at infinity.
[[nodiscard]] Imath::V3f emission_direction(const Light& light, const Imath::V3f& normal, Imath::V2f u,
                                            float time);

/// Factor from the mean emission of a light to its power: [m^2 sr], [sr] for lights at a point, [m^2] for
/// directional ones. Two-sided lights count both sides. For lights at infinity it counts the power through
/// the sphere of radius `scene_radius_m` [m].
[[nodiscard]] double etendue(const Light& light, double scene_radius_m);
/// Emission averaged over the emitting directions, in the unit of `Light`: its constant `emission`, or the
/// mean radiance of an environment image by solid angle.
[[nodiscard]] ScaledCurve mean_emission(const Light& light);
/// Spectral power of a light [W/nm]: its mean emission times its `etendue`.
[[nodiscard]] Curve power(const Light& light, double scene_radius_m);
/// Memory in bytes of the light and all its data except the emission, which other lights may share.
[[nodiscard]] std::size_t memory_bytes(const Light& light);

/// Central ray of a light without a shape at time 0, for drawings: infinite, with a unit direction away from
/// the light. Light at infinity starts 1.5 times the sphere's radius before its center. A point light's ray
/// points to that center, or along +x if it is there. Nothing for an environment light and for area lights.
[[nodiscard]] std::optional<BasicRay<double>> central_ray(const Light& light, const Ball& sphere);
/// Half the angle [rad] of the rays around the central ray that a drawing shows: pi for a point light, the
/// half angle of a spot light, 60 degrees for an area light.
[[nodiscard]] double fan_of(const Light& light);

}  // namespace abbe
