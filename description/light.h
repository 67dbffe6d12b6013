#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "description/emission.h"
#include "description/load_context.h"
#include "description/motion.h"
#include "description/surface.h"
#include "scene/lights/environment_image.h"
#include "scene/scene.h"

namespace abbe::spec {

/// A light without a surface in the scene, with its emission.
template <typename Source, typename Emission>
struct LightSource {
  Source source;
  Emission emission;
};
/// A surface that the scene file declares as a light.
template <typename Surface>
struct AreaLight {
  Surface surface;
  AreaLightEmission emission;
  bool two_sided = false;
  std::optional<schema::Located<std::string>> material;  ///< Black if absent.
};
struct Point {
  Imath::V3d at{0, 0, 0};
};
struct Spot {
  Imath::V3d at{0, 0, 0};
  Imath::V3d direction{0, 0, 0};
  double half_angle_deg = 0;
};
struct DaylightIrradiance : schema::Located<double> {};
struct DaylightIlluminance : schema::Located<double> {};
/// Strength of a light at infinity with a D65 spectrum, which replaces an emission.
using DaylightStrength = std::variant<std::monostate, DaylightIrradiance, DaylightIlluminance>;
struct DirectionalLight {
  Imath::V3d towards{0, 0, 0};
  DaylightStrength strength;
};
struct Sun {
  Imath::V3d towards{0, 0, 0};
  double angular_diameter_deg = 0.533;  ///< Mean angular diameter of the Sun seen from the Earth.
  DaylightStrength strength;
};
struct EnvironmentImage {
  schema::Located<std::string> file;
  Imath::V3d up{0, 0, 1};
  double rotate_deg = 0;
};
/// An environment light: uniform, or an image.
struct EnvironmentLight {
  std::variant<std::monostate, EnvironmentImage> image;
  SourcePosition where;
};
using PointLightSource = LightSource<Point, PointEmission>;
using SpotLightSource = LightSource<Spot, PointEmission>;
using DirectionalLightSource = LightSource<DirectionalLight, std::optional<DirectionalLightEmission>>;
using SunLightSource = LightSource<Sun, std::optional<SunEmission>>;
using EnvironmentLightSource = LightSource<EnvironmentLight, EnvironmentLightEmission>;
struct Light {
  std::optional<std::string> name;
  std::variant<std::monostate, AreaLight<Quad>, AreaLight<Sphere>, AreaLight<Disc>, PointLightSource,
               SpotLightSource, DirectionalLightSource, SunLightSource, EnvironmentLightSource>
      kind;
  SourcePosition where;
  std::optional<Motion> motion = {};
};
[[nodiscard]] schema::Fields fields(schema::Tag<Light>);

}  // namespace abbe::spec

namespace abbe::description {

/// Index of the shape of each light in `scene.shapes`; nothing for a light without a shape.
using AreaLightShapes = std::vector<std::optional<std::uint32_t>>;
/// Adds the surfaces of all area lights to `scene.shapes`, not yet as emitters.
[[nodiscard]] AreaLightShapes build_area_light_shapes(const std::vector<spec::Light>& lights,
                                                      LoadContext& context, Scene& scene);
/// Adds all lights to a scene that has been recentred.
void build_lights(const std::vector<spec::Light>& lights, const AreaLightShapes& surfaces,
                  LoadContext& context, Scene& scene);
/// Makes `scene.shapes[shape]` emit. Reports a shape whose material is a medium without a surface.
void add_area_light(const spec::Emission& emission, bool two_sided, std::uint32_t shape, LoadContext& context,
                    Scene& scene);

/// An environment light as read: no texels if it is uniform, else an image and its orientation.
struct EnvironmentTexels {
  int width = 0;
  int height = 0;
  std::vector<std::array<float, 3>> texels = {};
  EnvironmentFrame frame = {{0, 0, 1}, {0, 1, 0}};
};
/// Reads an environment light. Returns nothing after an error. Throws Error{input} or Error{resource} for an
/// image file that cannot be read or is too large.
[[nodiscard]] std::optional<EnvironmentTexels> build(const spec::EnvironmentLight& environment,
                                                     LoadContext& context);

}  // namespace abbe::description
