#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <ImathMatrix.h>
#include <ImathVec.h>

#include "io/inputs.h"
#include "io/json.h"
#include "io/object_reader.h"
#include "scene/scene.h"
#include "scene/shapes/mesh_file.h"

namespace abbe::description {

/// A shape as read, in metres.
struct Part {
  std::string name;
  PlainShape shape;
  std::uint32_t material;
};
/// What instances are made of, moved by `-center` to where floats are finest.
struct Object {
  struct Member {
    std::string name;
    std::uint32_t material;
    std::shared_ptr<const Prototype> prototype;
  };
  std::vector<Member> parts;
  Imath::V3d center{0, 0, 0};
};

/// A spectrum that lamps name, and what they hold of it.
struct LampSpectrum {
  Curve curve;          ///< As named.
  double power;         ///< Its integral,
  double luminous;      ///< and that of what the eye sees.
  double held_for = 0;  ///< `held` is the curve times this and 2^-`exponent`; 0 while there is none.
  int exponent = 0;
  std::shared_ptr<const Curve> held = nullptr;  ///< In [0, 1], so that no float overflows.
};

/// What the readers of one scene file share.
struct Reading {
  Diagnostics& diagnostics;
  std::filesystem::path folder;  ///< Of the scene file: where the files it names are looked for.
  Inputs* inputs = nullptr;      ///< Of the command, if it keeps account of them.
  double unit_m = 1;             ///< Metres per unit of length.
  std::vector<std::filesystem::path> files{};  ///< Every file named so far, for the hash.
  std::vector<SourcePosition> emissions{};     ///< Where each light's is told.
  std::vector<Imath::V3d> light_positions{};   ///< Of each light [m], in double until the scene is recentred.
  std::vector<SourcePosition> shape_places{};  ///< Where each shape of the scene is described.
  std::map<std::string, Object> objects{};
  std::unordered_map<std::string, LampSpectrum> lamp_spectra{};  ///< By the words that name them.
  std::unordered_map<std::string, std::uint32_t> materials{};    ///< Numbers by name.
  std::vector<std::shared_ptr<Placement>> placements{};  ///< Of each instance, until the scene is recentred.

  /// A file named by the scene, remembered for the hash; a URL is reported.
  [[nodiscard]] std::optional<std::filesystem::path> file(const std::string& name,
                                                          const SourcePosition& where);
  void remember(const std::filesystem::path& file);
  /// Counts memory that is about to be taken. Throws Error{resource} when it is too much.
  void take_memory(const std::string& what, std::size_t bytes) const;
  /// A table's name as the libraries take it: a user's `FILE.csv`, `FILE.csv:COLUMN` or `FILE.yml` is looked
  /// for beside the scene.
  [[nodiscard]] std::optional<std::string> table(const JsonValue& name);
};

/// Lengths and coordinates, in scene units: beyond this the floats of the render overflow when squared and
/// multiplied.
inline constexpr double kMaxLength = 1e12;
inline constexpr Range kCoordinate{-kMaxLength, kMaxLength};
inline constexpr Range kLength{0, kMaxLength, true, false};
/// Values of curves and powers, safely inside float.
inline constexpr Range kValue{-1e30, 1e30};
inline constexpr Range kPower{0, 1e30};
inline constexpr Range kExposure{0, 1e9, true, false};  ///< [s]
inline constexpr Range kWavelength{kMinWavelengthNm, kMaxWavelengthNm};

/// The `least` or more elements of an array; anything else is reported, `what` naming them.
[[nodiscard]] const JsonValue::Array* read_array(const JsonValue& json, std::string_view what,
                                                 std::size_t least, const Reading& reading);
/// A position or edge [m].
[[nodiscard]] std::optional<Imath::V3d> read_point(ObjectReader& reader, std::string_view key,
                                                   const Reading& reading);
/// A unit vector; the zero vector is reported.
[[nodiscard]] std::optional<Imath::V3d> read_direction(ObjectReader& reader, std::string_view key,
                                                       const Reading& reading);

/// Where a curve is used: the data folder its names are looked for in, and the values it may take.
struct CurveUse {
  std::string_view folder;
  Range allowed = kValue;
};
[[nodiscard]] std::optional<Curve> read_curve(const JsonValue& json, const CurveUse& use, Reading& reading);
/// The curves an emission shares with other curves: "blackbody_K", "daylight_K" and "lines".
[[nodiscard]] std::optional<Curve> read_source(std::string_view key, const JsonValue& json, Reading& reading);

void read_materials(const JsonValue& json, Reading& reading, Scene& scene);
/// Index of the material of that name; an unknown one is reported with the nearest.
[[nodiscard]] std::optional<std::uint32_t> find_material(const JsonValue& name, Reading& reading,
                                                         const Scene& scene);
/// Index of a mesh file's material in the scene, as "FILE:NAME"; what of it is lost is told in one warning.
[[nodiscard]] std::uint32_t add_file_material(const FileMaterial& material, const std::string& file,
                                              const JsonValue& at, Reading& reading, Scene& scene);
/// Index of the material of lamps that name none: diffuse, reflecting nothing.
[[nodiscard]] std::uint32_t black_material(Reading& reading, Scene& scene);
/// Warns of every lamp that emits nothing the sensor sees.
void check_lamps(const Reading& reading, const Scene& scene);
/// Reports what floats cannot tell apart, once the scene is recentred: a shape with matter inside, or a mesh
/// that emits, only few float steps large where it stands, and a view of little more than one direction.
void check_precision(const JsonValue& root, const Reading& reading, const Scene& scene);
/// Warns of every index used beyond the wavelengths it holds for.
void check_validity(const JsonValue& json, const Reading& reading, const Scene& scene);

/// What a `transform` does, as a matrix for row vectors [m], and the product of its uniform scales.
struct Transform {
  Imath::M44d matrix;
  double scale = 1;
};
/// Steps of uniform scale, rotation and translation.
[[nodiscard]] Transform read_similarity(const JsonValue& json, const Reading& reading);
/// Those, scales along the axes and matrices; a map without an inverse is reported.
[[nodiscard]] std::optional<Imath::M44d> read_affine(const JsonValue& json, const Reading& reading);

/// Makes a mesh the surface of the matter that its material may be: closed, facing outward, without vertex
/// normals. Says what it puts right, and what it cannot as what strictness refuses; `name` is that of the
/// mesh there.
void prepare_for_matter(Mesh& mesh, const std::string& name, const Material& material,
                        const SourcePosition& where, const Reading& reading);

[[nodiscard]] std::optional<Sphere> read_sphere(const JsonValue& json, const Reading& reading);
[[nodiscard]] std::optional<Disc> read_disc(const JsonValue& json, const Reading& reading);
[[nodiscard]] std::optional<Quad> read_quad(const JsonValue& json, const Reading& reading);
/// The shape of the kind `key`, placed; of a mesh file, one for each material. None after an error.
[[nodiscard]] std::vector<Part> read_parts(ObjectReader& reader, std::string_view key,
                                           const std::string& name, Reading& reading, Scene& scene);
/// The patches of a chart in the order of its table, then what surrounds them. None after an error.
[[nodiscard]] std::vector<Part> read_chart(const JsonValue& json, const std::string& name, Reading& reading,
                                           Scene& scene);
void read_shapes(const JsonValue& json, Reading& reading, Scene& scene);

void read_objects(const JsonValue& json, Reading& reading, Scene& scene);
/// The shapes of an object, placed.
void add_instance(const JsonValue& json, const std::string& name, Reading& reading, Scene& scene);

void shift(Mesh& mesh, const Imath::V3d& by);
void shift(Sphere& sphere, const Imath::V3d& by);
void shift(Disc& disc, const Imath::V3d& by);
void shift(Quad& quad, const Imath::V3d& by);
/// Nothing: instances may share their placements, which are moved once each.
void shift(PlacedShape& placed, const Imath::V3d& by);

void read_lights(const JsonValue& json, Reading& reading, Scene& scene);
/// Makes `scene.shapes[shape]` emit.
void add_area_light(const JsonValue& emission, bool two_sided, std::uint32_t shape, Reading& reading,
                    Scene& scene);

/// An environment: nothing but its light, or the texels of an image and which way it faces.
struct Sky {
  int width = 0;
  int height = 0;
  std::vector<std::array<float, 3>> texels = {};
  EnvironmentFrame frame = {{0, 0, 1}, {0, 1, 0}};
};
/// Throws Error{input} or Error{resource} for an image file that cannot be read or is too large.
[[nodiscard]] std::optional<Sky> read_sky(const JsonValue& json, Reading& reading);

/// The film: its pixels, and what they count.
struct Sensor {
  int width = 1;
  int height = 1;
  double pixel_pitch = 4.5e-6;  ///< [m]
  double fill_factor = 1;
  double exposure_s = 1;
  std::vector<Channel> channels;
  std::optional<Readout> readout;
  std::optional<Mosaic> mosaic;
  std::optional<SpectralBins> spectral;
};
/// `probe`: the sensor of an irradiance probe has one pixel unless it says otherwise.
[[nodiscard]] Sensor read_sensor(const JsonValue& json, bool probe, Reading& reading);

/// Bins of wavelength instead of channels.
[[nodiscard]] std::optional<SpectralBins> read_spectral(const JsonValue& json, const Reading& reading);

/// What the pixels of a sensor count, with its filters; the sensor's exposure is that of channels without
/// their own.
void read_channels(ObjectReader& reader, Sensor& sensor, Reading& reading);

[[nodiscard]] std::optional<Camera> read_camera(const JsonValue& json, const Sensor& sensor,
                                                Reading& reading);

}  // namespace abbe::description
