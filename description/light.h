#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "description/emission.h"
#include "description/load_context.h"
#include "description/surface.h"
#include "scene/lights/environment_image.h"
#include "scene/scene.h"

namespace abbe::spec {

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
struct PointLamp {
  Point point;
  PointEmission emission;
};
struct Spot {
  Imath::V3d at{0, 0, 0};
  Imath::V3d direction{0, 0, 0};
  double half_angle_deg = 0;
};
struct SpotLamp {
  Spot spot;
  PointEmission emission;
};
struct DaylightIrradiance : schema::Located<double> {};
struct DaylightIlluminance : schema::Located<double> {};
/// What a light from infinity may say in place of an emission.
using DaylightStrength = std::variant<std::monostate, DaylightIrradiance, DaylightIlluminance>;
struct Beam {
  Imath::V3d towards{0, 0, 0};
  DaylightStrength strength;
};
struct BeamLamp {
  Beam beam;
  std::optional<BeamEmission> emission;
};
struct Sun {
  Imath::V3d towards{0, 0, 0};
  double angular_diameter_deg = 0.533;  ///< Of ours, in the mean.
  DaylightStrength strength;
};
struct SunLamp {
  Sun sun;
  std::optional<SunEmission> emission;
};
/// Nothing but its light, or an image and which way it faces.
struct Sky {
  std::optional<schema::Located<std::string>> image;
  std::optional<schema::Located<Imath::V3d>> up;
  std::optional<schema::Located<double>> rotate_deg;
  SourcePosition where;
};
struct SkyLamp {
  Sky sky;
  SkyEmission emission;
};
struct Light {
  std::optional<std::string> name;
  std::variant<std::monostate, AreaLamp<Quad>, AreaLamp<Sphere>, AreaLamp<Disc>, PointLamp, SpotLamp,
               BeamLamp, SunLamp, SkyLamp>
      kind;
  SourcePosition where;
};
[[nodiscard]] const schema::Fields& fields(schema::Tag<Light>);
[[nodiscard]] schema::Kind lights();

}  // namespace abbe::spec

namespace abbe::description {

void build_lights(const std::vector<spec::Light>& lights, LoadContext& context, Scene& scene);
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
