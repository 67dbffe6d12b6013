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

/// What shines, and what it sends out.
template <typename Source, typename Emission>
struct Lamp {
  Source source;
  Emission emission;
};
/// A surface that is there to emit.
template <typename Surface>
struct AreaLamp {
  Surface surface;
  LampEmission emission;
  bool two_sided = false;
  std::optional<schema::Located<std::string>> material;  ///< Black when absent.
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
/// What a light from infinity may say in place of an emission.
using DaylightStrength = std::variant<std::monostate, DaylightIrradiance, DaylightIlluminance>;
struct Beam {
  Imath::V3d towards{0, 0, 0};
  DaylightStrength strength;
};
struct Sun {
  Imath::V3d towards{0, 0, 0};
  double angular_diameter_deg = 0.533;  ///< Of ours, in the mean.
  DaylightStrength strength;
};
struct SkyImage {
  schema::Located<std::string> file;
  Imath::V3d up{0, 0, 1};
  double rotate_deg = 0;
};
/// Nothing but its light, or an image.
struct Sky {
  std::variant<std::monostate, SkyImage> image;
  SourcePosition where;
};
using PointLamp = Lamp<Point, PointEmission>;
using SpotLamp = Lamp<Spot, PointEmission>;
using BeamLamp = Lamp<Beam, std::optional<BeamEmission>>;
using SunLamp = Lamp<Sun, std::optional<SunEmission>>;
using SkyLamp = Lamp<Sky, SkyEmission>;
struct Light {
  std::optional<std::string> name;
  std::variant<std::monostate, AreaLamp<Quad>, AreaLamp<Sphere>, AreaLamp<Disc>, PointLamp, SpotLamp,
               BeamLamp, SunLamp, SkyLamp>
      kind;
  SourcePosition where;
  std::optional<Motion> motion = {};
};
[[nodiscard]] schema::Fields fields(schema::Tag<Light>);

}  // namespace abbe::spec

namespace abbe::description {

/// The shape that each light has, if it has one.
using LampSurfaces = std::vector<std::optional<std::uint32_t>>;
/// Adds the surfaces of all lamps.
[[nodiscard]] LampSurfaces build_lamp_surfaces(const std::vector<spec::Light>& lights, LoadContext& context,
                                               Scene& scene);
/// Adds all lights to a scene whose origin is known.
void build_lights(const std::vector<spec::Light>& lights, const LampSurfaces& surfaces, LoadContext& context,
                  Scene& scene);
/// Makes `scene.shapes[shape]` emit.
void add_area_light(const spec::Emission& emission, bool two_sided, std::uint32_t shape, LoadContext& context,
                    Scene& scene);

/// An environment: nothing but its light, or the texels of an image and which way it faces.
struct Sky {
  int width = 0;
  int height = 0;
  std::vector<std::array<float, 3>> texels = {};
  EnvironmentFrame frame = {{0, 0, 1}, {0, 1, 0}};
};
/// Throws Error{input} or Error{resource} for an image file that cannot be read or is too large.
[[nodiscard]] std::optional<Sky> build(const spec::Sky& sky, LoadContext& context);

}  // namespace abbe::description
