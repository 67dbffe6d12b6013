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
#include "spectral/scaled_curve.h"

namespace abbe {

struct ShapeInstance;

/// Where light arrives to be scattered: at a point, on the side of a surface that a unit normal says, or from
/// everywhere.
struct LightSampleContext {
  Imath::V3f point{0, 0, 0};
  std::optional<Imath::V3f> side = {};
  bool glossy = false;  ///< Whether it is scattered in lobes, by which light from everywhere is found.
};

/// Density [1/sr] of directions drawn uniformly from a cone, `cap` being 1 - cos of its half angle.
[[nodiscard]] inline float cone_pdf(float cap) {
  return 1 / (2 * std::numbers::pi_v<float> * cap);
}

/// A quad that emits, as points are drawn on it.
struct EmittingQuad {
  RenderedQuad quad;
  std::optional<Rectangle> rectangle;  ///< Of one with right angles.
};

/// A surface that emits the same radiance in all directions from its outer side, or from both.
struct AreaLight {
  std::uint32_t shape = 0;  ///< Index into `Scene::shapes`.
  bool two_sided = false;
  double area = 0;                       ///< Of one side [m^2]; `measure` works out this and the next.
  std::vector<float> triangle_cdf = {};  ///< For meshes: cumulative share of area.
  std::shared_ptr<const EmittingQuad> flat = nullptr;  ///< For quads; apart, since other lights have none.

  /// Works out what depends on the shape.
  void measure(const Shape& of);
};
/// Emits equally in all directions from one point.
struct PointLight {
  Imath::V3f position{0, 0, 0};  ///< Of one that moves, at time 0.
  std::shared_ptr<const Motion> motion = nullptr;
};
/// Emits equally within a cone around `axis`, nothing outside.
struct SpotLight {
  Imath::V3f position{0, 0, 0};  ///< Of one that moves, this and the axis at time 0.
  Imath::V3f axis{0, 0, 1};
  float cap = 2;  ///< 1 - cos of the half angle, which keeps its digits however narrow the cone.
  std::shared_ptr<const Motion> motion = nullptr;

  [[nodiscard]] Imath::V3f axis_at(float time) const;
  /// Whether the unit direction `wi` from the lamp is within the cone: |wi - axis|^2 = 2 (1 - cos).
  [[nodiscard]] bool lights(const Imath::V3f& wi, float time) const {
    return (wi - (motion ? axis_at(time) : axis)).length2() <= 2 * cap;
  }
};
/// Light from infinity: the same radiance from all directions, or as an image says.
struct EnvironmentLight {
  std::shared_ptr<const EnvironmentImage> image = nullptr;

  /// Density [1/sr] of the unit direction `wi` as drawn for a place: by the image, or without one by the
  /// cosine on the side that light can come to, evenly where that is everywhere.
  [[nodiscard]] float pdf(const LightSampleContext& place, const Imath::V3f& wi) const;
};
/// A parallel beam from infinity. `towards` is the unit direction from the scene to where it comes from.
struct DirectionalLight {
  Imath::V3f towards{0, 0, 1};
};
/// A disc at infinity around the unit direction `towards`, of the same radiance all over, which cameras see.
struct SunLight {
  Imath::V3f towards{0, 0, 1};
  float cap = 1;  ///< 1 - cos of the half angle it is seen under, as of a spot.

  /// Whether the unit direction `wi` meets it.
  [[nodiscard]] bool shows(const Imath::V3f& wi) const { return (wi - towards).length2() <= 2 * cap; }
  /// Irradiance of a surface that faces it, over its radiance [sr]: pi sin^2 of the half angle.
  [[nodiscard]] double projected_solid_angle() const;
};

/// A light: where it is, and its emission: spectral radiance [W m^-2 sr^-1 nm^-1] of an area or environment
/// light or a sun, spectral intensity [W sr^-1 nm^-1] of a point or spot light, spectral irradiance
/// [W m^-2 nm^-1], of a surface that faces it, of a directional light. With an image, that of a texel (1, 1,
/// 1).
struct Light {
  std::string name;
  std::variant<AreaLight, PointLight, SpotLight, EnvironmentLight, DirectionalLight, SunLight> kind;
  ScaledCurve emission;
  std::optional<LampPolarisation> polarisation = {};

  template <typename... Kinds>
  [[nodiscard]] bool is() const {
    return (std::holds_alternative<Kinds>(kind) || ...);
  }
  /// Comes from a single direction at every point, so that no scattering finds it.
  [[nodiscard]] bool is_delta() const { return is<PointLight, SpotLight, DirectionalLight>(); }
  [[nodiscard]] bool is_environment() const { return is<EnvironmentLight>(); }
  /// Has no place.
  [[nodiscard]] bool at_infinity() const { return is<EnvironmentLight, DirectionalLight, SunLight>(); }
};

/// Where a point or spot light is, of one that moves at time 0; nullptr for the others.
[[nodiscard]] const Imath::V3f* place(const Light& light);
/// Where it is at that time.
[[nodiscard]] Imath::V3f place_at(const PointLight& lamp, float time);
[[nodiscard]] Imath::V3f place_at(const SpotLight& lamp, float time);
/// How a light moves; nullptr of one that stands still.
[[nodiscard]] const Motion* motion_of(const Light& light, const std::vector<ShapeInstance>& shapes);

/// The emission at these wavelengths of light arriving from the unit direction `wi`, which only an
/// environment image asks for.
[[nodiscard]] SampledSpectrum emission_from(const Light& light, const Imath::V3f& wi,
                                            const SampledSpectrum& wavelengths_nm);

/// How light of it is polarised that travels in that unit direction; nothing of an ordinary lamp, and of a
/// linearly polarised one along its very axis.
[[nodiscard]] std::optional<Polarised> polarisation_of(const Light& light, const Imath::V3f& travels);

/// Light arriving at a point at some time, without its spectrum: `factor` times `emission_from` is the
/// incident radiance (area, environment, sun) or irradiance per unit cosine (point, spot, directional), and
/// `pdf` the density of `wi` [1/sr] (1 for delta lights, whose direction is no choice).
struct LightSample {
  Imath::V3f wi;
  float distance;  ///< infinity for lights there
  float factor;
  float pdf;
  Imath::V3f end;  ///< Where a shadow ray ends: the point of the light, moved off its surface; meaningless
                   ///< at infinity.
  Imath::V3f normal{0, 0, 0};  ///< Outward, of an area light there; zero for the others.
};

/// Draws a direction from a place towards the light at that time; nothing if the light cannot reach it.
/// Spheres seen from outside are drawn by solid angle [Pharr2023, sec. 6.2.4], rectangles that look large too
/// [Urena2013], environments as they say, all else by area.
[[nodiscard]] std::optional<LightSample> sample_light(const Light& light,
                                                      const std::vector<ShapeInstance>& shapes,
                                                      const LightSampleContext& place, Imath::V2f u,
                                                      float time);

/// Density [1/sr] with which `sample_light` draws the direction from a place that hits the light at
/// `hit_point` with outward normal `hit_normal`; for lights at infinity pass the direction in `wi` only. 0
/// for delta lights.
[[nodiscard]] float light_pdf(const Light& light, const std::vector<ShapeInstance>& shapes,
                              const LightSampleContext& place, const Imath::V3f& wi,
                              const Imath::V3f& hit_point, const Imath::V3f& hit_normal, float time);

/// Whether the light emits from a surface point with outward `normal` into direction `wo` (away from the
/// surface).
[[nodiscard]] bool emits_towards(const Light& light, const Imath::V3f& normal, const Imath::V3f& wo);

/// A starting point of photons of some time: the surface position and outward normal of an area light, or the
/// point itself with a zero normal. Lights at infinity have none: Error{internal}.
struct EmissionPoint {
  Imath::V3f point;
  Imath::V3f normal;
  float pdf_area;  ///< [1/m^2]; 1 for point and spot lights.
};
[[nodiscard]] EmissionPoint sample_emission_point(const Light& light,
                                                  const std::vector<ShapeInstance>& shapes, Imath::V2f u,
                                                  float time);
/// Numbers for `sample_emission_point` that are spread over a light, its middle first: where all of a light
/// is to be looked at.
inline constexpr std::array<std::array<float, 2>, 5> kSpreadOverLight{
    {{0.5F, 0.5F}, {0.05F, 0.05F}, {0.95F, 0.05F}, {0.05F, 0.95F}, {0.95F, 0.95F}}};

/// What the mean emission of a light is multiplied by to give its power: [m^2 sr], [sr] for point and spot
/// lights, [m^2] for directional ones; of lights at infinity, through the sphere of radius `scene_radius_m`
/// [m].
[[nodiscard]] double etendue(const Light& light, double scene_radius_m);
/// Emission averaged over directions: that of the light, or of the mean texel of an environment image.
[[nodiscard]] ScaledCurve mean_emission(const Light& light);
/// Spectral power of a light [W/nm]: its mean emission times its `etendue`.
[[nodiscard]] Curve power(const Light& light, double scene_radius_m);
/// Bytes of the light itself and all it holds, but for its emission, which others may share.
[[nodiscard]] std::size_t memory_bytes(const Light& light);

}  // namespace abbe
