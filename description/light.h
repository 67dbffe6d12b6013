#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "description/emission.h"
#include "description/load_context.h"
#include "description/motion.h"
#include "description/surface.h"
#include "scene/lights/infinite_light.h"
#include "scene/scene.h"

// Lights as scene files describe them. Lengths and positions are in the scene file's unit; directions are in
// its coordinates and have any length except 0.
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
  bool two_sided = false;                                ///< True if its back emits too.
  std::optional<schema::Located<std::string>> material;  ///< Name of its material; black if absent.
};
/// A point with the same intensity in all directions.
struct Point {
  Imath::V3d at{0, 0, 0};  ///< Position.
};
/// A point with constant intensity within a cone, and zero outside.
struct Spot {
  Imath::V3d at{0, 0, 0};         ///< Position.
  Imath::V3d direction{0, 0, 0};  ///< Axis of the cone, along the light.
  double half_angle_deg = 0;      ///< Half-angle of the cone, in [0.1, 180].
};
/// A point with the intensity distribution of a luminaire. Without a scale or a spectral flux its emission
/// has the luminous flux of the file, and only the shape of the spectrum counts.
struct Photometric {
  Imath::V3d at{0, 0, 0};             ///< Position.
  schema::Located<std::string> file;  ///< An IES LM-63 (.ies) or EULUMDAT (.ldt) file.
  Imath::V3d axis{0, 0, -1};          ///< Direction of gamma = 0: of a ceiling luminaire, downwards.
  Imath::V3d c0{1, 0, 0};             ///< Its component perpendicular to the axis is the direction of C = 0.
};
/// Irradiance [W/m^2] over 300-1100 nm of a surface that faces the light, with the spectrum D65.
struct DaylightIrradiance : schema::Located<double> {};
/// Illuminance [lx] of a surface that faces the light, with the spectrum D65.
struct DaylightIlluminance : schema::Located<double> {};
/// Strength of a light at infinity with the spectrum D65. It replaces an emission; std::monostate if the
/// light has an emission.
using DaylightStrength = std::variant<std::monostate, DaylightIrradiance, DaylightIlluminance>;
/// Parallel light from infinity.
struct DirectionalLight {
  Imath::V3d towards{0, 0, 0};  ///< Direction from the scene to where the light comes from.
  DaylightStrength strength;
};
/// A disc at infinity with uniform radiance.
struct Sun {
  Imath::V3d towards{0, 0, 0};          ///< Direction from the scene to the center of the disc.
  double angular_diameter_deg = 0.533;  ///< Mean angular diameter of the Sun seen from the Earth.
  DaylightStrength strength;
};
/// An equirectangular image of linear Rec.709 radiance.
struct EnvironmentImage {
  schema::Located<std::string> file;
  Imath::V3d up{0, 0, 1};  ///< Direction of the image's top row.
  /// Right-handed rotation about `up`. Without it the center column looks along +y, or +x if `up` is parallel
  /// to y.
  double rotate_deg = 0;
};
/// An environment light: uniform, or an image.
struct EnvironmentLight {
  std::variant<std::monostate, EnvironmentImage> image;
  SourcePosition where;
};
using PointLightSource = LightSource<Point, PointEmission>;
using SpotLightSource = LightSource<Spot, PointEmission>;
using PhotometricLightSource = LightSource<Photometric, PointEmission>;
using DirectionalLightSource = LightSource<DirectionalLight, std::optional<DirectionalLightEmission>>;
using SunLightSource = LightSource<Sun, std::optional<SunEmission>>;
using EnvironmentLightSource = LightSource<EnvironmentLight, EnvironmentLightEmission>;
/// A light of a scene file. `std::monostate` means that none has been read.
struct Light {
  std::optional<std::string> name;  ///< If absent, messages call it "light N", counted from 0.
  Joined<std::variant<std::monostate>, Each<AreaLight, PlainSurface>::type,
         std::variant<PointLightSource, SpotLightSource, PhotometricLightSource, DirectionalLightSource,
                      SunLightSource, EnvironmentLightSource>>::type kind;
  SourcePosition where;
  std::optional<Motion> motion = {};  ///< Motion relative to the described pose; at rest if absent.
};
/// Key table of `Light`.
[[nodiscard]] schema::Fields fields(schema::Tag<Light>);

}  // namespace abbe::spec

namespace abbe::description {

// Errors of the functions below go to `context.diagnostics`.

/// Index in `scene.shapes` of the shape of each light, in the order of the lights. Nothing for a light
/// without a shape or with an error.
using AreaLightShapes = std::vector<std::optional<std::uint32_t>>;
/// Adds the surfaces of all area lights to `scene.shapes`, not yet as emitters. Call it before the scene is
/// recentred, and once materials are built. Reports errors of surfaces and motions, and unknown materials.
[[nodiscard]] AreaLightShapes build_area_light_shapes(const std::vector<spec::Light>& lights,
                                                      LoadContext& context, Scene& scene);
/// Adds all lights to `scene.lights` of a scene that has been recentred and has its channels. `surfaces` is
/// the result of `build_area_light_shapes` for the same lights. A light with an error is left out. Reports
/// errors of emissions and motions, a moving light at infinity and a second environment light. Throws as
/// `build` below.
void build_lights(const std::vector<spec::Light>& lights, const AreaLightShapes& surfaces,
                  LoadContext& context, Scene& scene);
/// Makes `scene.shapes[shape]` an area light: appends it to `scene.lights` under the name of the shape. Adds
/// nothing after an error: a shape whose material is a medium without an interface, or an error of the
/// emission.
void add_area_light(const spec::Emission& emission, bool two_sided, std::uint32_t shape, LoadContext& context,
                    Scene& scene);

/// An environment light as read: no texels if it is uniform, else an equirectangular image and its
/// orientation.
struct EnvironmentTexels {
  int width = 0;   ///< [px]
  int height = 0;  ///< [px]
  /// Linear Rec.709 values of 0 or more, row by row from the top row, each row from the left.
  std::vector<std::array<float, 3>> texels = {};
  EnvironmentFrame frame = {{0, 0, 1}, {0, 1, 0}};
};
/// Reads an environment light. Negative values become 0, with a warning; an image that is black everywhere is
/// a warning. Reports to `context.diagnostics`, and returns nothing for:
/// - a URL, and a file other than .exr or .hdr;
/// - an image without channels R, G and B, or only Y, and one with other primaries;
/// - a texel that is not finite or exceeds 1e30.
/// Throws Error{input} for an image file that cannot be read, and Error{resource} for one that is too large.
[[nodiscard]] std::optional<EnvironmentTexels> build(const spec::EnvironmentLight& environment,
                                                     LoadContext& context);

/// Reads the intensity distribution of a luminaire, with all half-planes that its symmetry implies:
/// - `.ies`: ANSI/IES LM-63 of 1986, 1991, 1995, 2002 or 2019 with type C photometry. Intensities are
///   multiplied by the candela multiplier and the ballast factor, and in files before 1995 by the
///   photometric factor that follows it. The factors of TILT=INCLUDE are not applied; a warning says so.
/// - `.ldt`: EULUMDAT, in cd/klm times the flux of the first set of light sources and the conversion factor.
/// Reports to `context.diagnostics`, and returns nullptr for:
/// - a URL, another extension, a file that cannot be read and one that ends too early;
/// - photometry of types A and B, tilt factors in another file, and angles that do not fit the symmetry;
/// - numbers that are not finite or out of their range, and intensities that are all 0.
/// Throws Error{resource} if the memory limit is exceeded.
[[nodiscard]] std::shared_ptr<const IntensityDistribution> read_photometric_file(
    const schema::Located<std::string>& name, LoadContext& context);

}  // namespace abbe::description
