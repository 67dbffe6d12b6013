#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <ImathVec.h>

#include "scene/lights/environment_image.h"
#include "scene/lights/spherical_rectangle.h"
#include "scene/ray.h"
#include "scene/shapes/quad.h"
#include "scene/shapes/shape.h"
#include "spectral/scaled_curve.h"

namespace abbe {

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
  Imath::V3f position{0, 0, 0};
};
/// Emits equally within a cone around `axis`, nothing outside.
struct SpotLight {
  Imath::V3f position{0, 0, 0};
  Imath::V3f axis{0, 0, 1};
  float cap = 2;  ///< 1 - cos of the half angle, which keeps its digits however narrow the cone.

  /// Whether the unit direction `wi` from the lamp is within the cone: |wi - axis|^2 = 2 (1 - cos).
  [[nodiscard]] bool lights(const Imath::V3f& wi) const { return (wi - axis).length2() <= 2 * cap; }
};
/// Light from infinity: the same radiance from all directions, or as an image says.
struct EnvironmentLight {
  std::shared_ptr<const EnvironmentImage> image = nullptr;
};

/// A light: where it is, and its emission: spectral radiance [W m^-2 sr^-1 nm^-1] of an area or environment
/// light, spectral intensity [W sr^-1 nm^-1] of a point or spot light. With an image, that of a texel (1, 1,
/// 1).
struct Light {
  std::string name;
  std::variant<AreaLight, PointLight, SpotLight, EnvironmentLight> kind;
  ScaledCurve emission;

  [[nodiscard]] bool is_delta() const { return kind.index() == 1 || kind.index() == 2; }
  [[nodiscard]] bool is_environment() const { return kind.index() == 3; }
};

/// The emission at these wavelengths of light arriving from the unit direction `wi`, which only an
/// environment image asks for.
[[nodiscard]] SampledSpectrum emission_from(const Light& light, const Imath::V3f& wi,
                                            const SampledSpectrum& wavelengths_nm);

/// Light arriving at a point, without its spectrum: `factor` times `emission_from` is the incident radiance
/// (area, environment) or irradiance per unit cosine (point, spot), and `pdf` the density of `wi` [1/sr] (1
/// for delta lights, whose direction is no choice).
struct LightSample {
  Imath::V3f wi;
  float distance;  ///< infinity for the environment
  float factor;
  float pdf;
  Imath::V3f end;  ///< Where a shadow ray ends: the point of the light, moved off its surface; meaningless
                   ///< for the environment.
};

struct ShapeInstance;

/// Draws a direction from `point` towards the light; nothing if the light cannot reach it. Spheres seen from
/// outside are drawn by solid angle [Pharr2023, sec. 6.2.4], rectangles that look large too [Urena2013], all
/// else by area.
[[nodiscard]] std::optional<LightSample> sample_light(const Light& light,
                                                      const std::vector<ShapeInstance>& shapes,
                                                      const Imath::V3f& point, Imath::V2f u);

/// Density [1/sr] with which `sample_light` draws the direction from `point` that hits the light at
/// `hit_point` with outward normal `hit_normal`; for the environment pass the direction in `wi` only. 0 for
/// delta lights.
[[nodiscard]] float light_pdf(const Light& light, const std::vector<ShapeInstance>& shapes,
                              const Imath::V3f& point, const Imath::V3f& wi, const Imath::V3f& hit_point,
                              const Imath::V3f& hit_normal);

/// Whether the light emits from a surface point with outward `normal` into direction `wo` (away from the
/// surface).
[[nodiscard]] bool emits_towards(const Light& light, const Imath::V3f& normal, const Imath::V3f& wo);

/// A starting point of photons: the surface position and outward normal of an area light, or the point itself
/// with a zero normal. Environments have none: Error{internal}.
struct EmissionPoint {
  Imath::V3f point;
  Imath::V3f normal;
  float pdf_area;  ///< [1/m^2]; 1 for point and spot lights.
};
[[nodiscard]] EmissionPoint sample_emission_point(const Light& light,
                                                  const std::vector<ShapeInstance>& shapes, Imath::V2f u);

/// What its mean emission is multiplied by to give its power: [m^2 sr], or [sr] for point and spot lights; of
/// the environment, through the sphere of radius `scene_radius_m`.
[[nodiscard]] double etendue(const Light& light, double scene_radius_m);
/// Emission averaged over directions: that of the light, or of the mean texel of an environment image.
[[nodiscard]] ScaledCurve mean_emission(const Light& light);
/// Spectral power [W/nm]: the product of the two.
[[nodiscard]] Curve power(const Light& light, double scene_radius_m);
/// Of the light itself and all it holds, but for its emission, which others may share.
[[nodiscard]] std::size_t memory_bytes(const Light& light);

}  // namespace abbe
