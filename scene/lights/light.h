#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <ImathVec.h>

#include "scene/lights/environment_image.h"
#include "scene/lights/polarisation.h"
#include "scene/lights/spherical_rectangle.h"
#include "scene/shapes/quad.h"
#include "scene/shapes/ray.h"
#include "scene/shapes/shape.h"
#include "spectral/curve.h"

namespace abbe {

struct ShapeInstance;

/// The point for which light is sampled. `side` is the unit normal of the side of a surface that receives the
/// light, if it receives it from one side only.
struct LightSampleContext {
  Imath::V3f point{0, 0, 0};  ///< Render coordinates [m].
  std::optional<Imath::V3f> side = {};
  bool glossy = false;  ///< True if the BSDF has glossy lobes, which sample environment light better.
};

/// Density [1/sr] of directions uniform in a cone; `cap` is 1 - cos of its half angle, in (0, 2].
[[nodiscard]] inline float cone_pdf(float cap) {
  return 1 / (2 * std::numbers::pi_v<float> * cap);
}

/// An emitting quad, in the form that is used to sample points.
struct EmittingQuad {
  RenderedQuad quad;
  std::optional<Rectangle> rectangle;  ///< Present if the quad has right angles.
};

/// A surface that emits uniform radiance in all directions, from its outer side or from both sides.
struct AreaLight {
  std::uint32_t shape = 0;  ///< Index into `Scene::shapes`.
  bool two_sided = false;
  double area = 0;  ///< Area of one side [m^2]; 0 before `measure`.
  /// Cumulative fraction of the area by triangle, ending in 1; empty except for meshes.
  std::vector<float> triangle_cdf = {};
  /// The quad, for lights that are quads. Other lights do not spend memory on it.
  std::shared_ptr<const EmittingQuad> flat = nullptr;

  /// Computes `area`, `triangle_cdf` and `flat` from the light's shape. Throws Error{internal} for a static
  /// instance. `Scene::commit` calls it.
  void measure(const Shape& of);
};
/// A point that emits equally in all directions.
struct PointLight {
  Imath::V3f position{0, 0, 0};                    ///< Render coordinates [m]; at time 0 if it moves.
  std::shared_ptr<const Motion> motion = nullptr;  ///< Null if it does not move.
};
/// A point that emits equally within a cone around `axis`.
struct SpotLight {
  Imath::V3f position{0, 0, 0};  ///< Render coordinates [m]; at time 0 if it moves.
  Imath::V3f axis{0, 0, 1};      ///< Unit propagation direction along the cone's axis; at time 0 if it moves.
  float cap = 2;                 ///< 1 - cos of the half angle, in (0, 2]; precise for narrow cones.
  std::shared_ptr<const Motion> motion = nullptr;  ///< Null if it does not move.

  /// The axis at that time of the exposure.
  [[nodiscard]] Imath::V3f axis_at(float time) const;
  /// True if the unit propagation direction `wi`, away from the light, lies in the cone: |wi - axis|^2 <= 2
  /// (1 - cos).
  [[nodiscard]] bool illuminates(const Imath::V3f& wi, float time) const {
    return (wi - (motion ? axis_at(time) : axis)).length2() <= 2 * cap;
  }
};
/// Light from infinity: uniform radiance, or that of an image.
struct EnvironmentLight {
  std::shared_ptr<const EnvironmentImage> image = nullptr;

  /// Density [1/sr] of the unit direction `wi`, from the point towards the light, as sampled for that point.
  /// With an image it follows the image. Otherwise it is proportional to the cosine on the receiving side, or
  /// uniform if there is no such side.
  [[nodiscard]] float pdf(const LightSampleContext& context, const Imath::V3f& wi) const;
};
/// Parallel light from infinity. `towards` is the unit direction from the scene towards the source.
struct DirectionalLight {
  Imath::V3f towards{0, 0, 1};
};
/// A disc at infinity around the unit direction `towards`, with uniform radiance and visible to cameras.
struct SunLight {
  Imath::V3f towards{0, 0, 1};
  float cap = 1;  ///< 1 - cos of its angular radius, in (0, 1].

  /// True if the unit direction `wi` points to the disc.
  [[nodiscard]] bool contains(const Imath::V3f& wi) const { return (wi - towards).length2() <= 2 * cap; }
  /// Irradiance of a perpendicular surface divided by the radiance [sr]: pi sin^2 of the angular radius.
  [[nodiscard]] double projected_solid_angle() const;
};

/// A light: its kind with its position, and its emission spectrum. The emission is
/// - spectral radiance [W m^-2 sr^-1 nm^-1] for an area light, environment light or sun. For an environment
///   image it is the radiance of a texel (1, 1, 1);
/// - spectral intensity [W sr^-1 nm^-1] for a point or spot light;
/// - spectral irradiance [W m^-2 nm^-1] of a perpendicular surface for a directional light.
struct Light {
  std::string name;
  std::variant<AreaLight, PointLight, SpotLight, EnvironmentLight, DirectionalLight, SunLight> kind;
  ScaledCurve emission;
  std::optional<LightPolarisation> polarisation = {};  ///< Nothing for unpolarised light.

  /// True if the light is one of these kinds.
  template <typename... Kinds>
  [[nodiscard]] bool is() const {
    return (std::holds_alternative<Kinds>(kind) || ...);
  }
  /// True if it arrives from a single direction at every point, so that BSDF sampling cannot hit it.
  [[nodiscard]] bool is_delta() const { return is<PointLight, SpotLight, DirectionalLight>(); }
  [[nodiscard]] bool is_environment() const { return is<EnvironmentLight>(); }
  /// True if it has no position.
  [[nodiscard]] bool at_infinity() const { return is<EnvironmentLight, DirectionalLight, SunLight>(); }
};

/// Position of a point or spot light, at time 0 if it moves; nullptr for other lights.
[[nodiscard]] const Imath::V3f* light_position(const Light& light);
/// Position [m] of a light at that time, a fraction of the exposure.
[[nodiscard]] Imath::V3f position_at(const PointLight& light, float time);
[[nodiscard]] Imath::V3f position_at(const SpotLight& light, float time);
/// Motion of a light, for an area light that of its shape in `shapes`; nullptr if it does not move.
[[nodiscard]] const Motion* motion_of(const Light& light, const std::vector<ShapeInstance>& shapes);

/// Emission at these wavelengths, in the unit of `Light`, of light that arrives from the unit direction `wi`,
/// which points towards the light. Only an environment image depends on the direction. Visibility, the
/// emitting side and the cone of a spot light are not tested.
[[nodiscard]] SampledSpectrum emission_from(const Light& light, const Imath::V3f& wi,
                                            const SampledSpectrum& wavelengths_nm);

/// Polarisation state of the light's emission along the unit propagation direction `travels`. Nothing for
/// unpolarised lights, and for a linearly polarised one along its own axis.
[[nodiscard]] std::optional<PolarisationState> polarisation_of(const Light& light, const Imath::V3f& travels);

/// A sampled direction towards a light. `factor` times `emission_from` is the incident radiance (area,
/// environment, sun) or the irradiance of a perpendicular surface (point, spot, directional). Visibility is
/// not tested.
struct LightSample {
  Imath::V3f wi;   ///< Unit direction from the point towards the light.
  float distance;  ///< [m]; infinite for lights at infinity.
  float factor;    ///< 1/distance^2 [1/m^2] for point and spot lights, otherwise 1.
  float pdf;       ///< Density of `wi` [1/sr]; 1 for delta lights.
  /// End of the shadow ray: the point of the light, offset from its surface. Undefined for lights at
  /// infinity.
  Imath::V3f end;
  Imath::V3f normal{0, 0, 0};  ///< Outward unit normal of an area light there; zero for the others.
};

/// Samples a direction from a point towards the light at that time by `u` in [0, 1)^2. Nothing if the sampled
/// point of the light cannot illuminate the point: it emits to the other side, or the point lies outside the
/// cone of a spot light.
/// - Spheres seen from outside are sampled by solid angle [Pharr2023, sec. 6.2.4], as are rectangles of large
///   solid angle [Urena2013]. All other area lights are sampled by area.
/// - An environment light is sampled by `EnvironmentLight::pdf`, a sun uniformly over its solid angle.
[[nodiscard]] std::optional<LightSample> sample_light(const Light& light,
                                                      const std::vector<ShapeInstance>& shapes,
                                                      const LightSampleContext& context, Imath::V2f u,
                                                      float time);

/// Density [1/sr] with which `sample_light` samples the unit direction `wi` that hits the light at
/// `hit_point` with outward unit normal `hit_normal`. For lights at infinity only `wi` has an effect. 0 for
/// delta lights, and where the light does not emit towards the point.
[[nodiscard]] float light_pdf(const Light& light, const std::vector<ShapeInstance>& shapes,
                              const LightSampleContext& context, const Imath::V3f& wi,
                              const Imath::V3f& hit_point, const Imath::V3f& hit_normal, float time);

/// True if the light emits from a surface point with outward `normal` in the direction `wo`, which points
/// away from the surface. Always true for lights without a surface.
[[nodiscard]] bool emits_towards(const Light& light, const Imath::V3f& normal, const Imath::V3f& wo);

/// A starting point of photons: position and outward normal on an area light, or the position of a point or
/// spot light with a zero normal.
struct EmissionPoint {
  Imath::V3f point;
  Imath::V3f normal;
  float pdf_area;  ///< Density by area [1/m^2]; 1 for point and spot lights.
};
/// Samples a starting point at that time, uniformly by area, by `u` in [0, 1)^2. Throws Error{internal} for a
/// light at infinity.
[[nodiscard]] EmissionPoint sample_emission_point(const Light& light,
                                                  const std::vector<ShapeInstance>& shapes, Imath::V2f u,
                                                  float time);
/// Random numbers for `sample_emission_point`, or fractions for `probe_point`, that represent a whole light
/// or probe. Those of its center come first.
inline constexpr std::array<std::array<float, 2>, 5> kRepresentativePoints{
    {{0.5F, 0.5F}, {0.05F, 0.05F}, {0.95F, 0.05F}, {0.05F, 0.95F}, {0.95F, 0.95F}}};

/// Factor from the mean emission of a light to its power: [m^2 sr], [sr] for point and spot lights, [m^2] for
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

}  // namespace abbe
