#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace abbe::soak {

/// Random generator of a scene. A seed gives the same scene on every platform. The distributions below are
/// written out, since those of the standard library differ between implementations. Only braced lists, whose
/// order is defined, draw twice in one expression.
using Random = std::mt19937_64;

/// Uniform in [low, high); low <= high.
inline double uniform(Random& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11U) * 0x1p-53;
}

/// Log-uniform in [low, high), with 0 < low.
inline double decades(Random& random, double low, double high) {
  return std::exp(uniform(random, std::log(low), std::log(high)));
}

inline bool chance(Random& random, double probability) {
  return uniform(random, 0, 1) < probability;
}

/// Log-uniform absolute value in [low, high), with 0 < low, and either sign with probability 1/2.
inline double signed_decades(Random& random, double low, double high) {
  const double size = decades(random, low, high);
  return chance(random, 0.5) ? -size : size;
}

/// Uniform in [low, high].
inline int integer(Random& random, int low, int high) {
  return low + static_cast<int>(uniform(random, 0, high - low + 1));
}

/// One of the values with equal probabilities; there must be at least one.
template <typename T>
const T& one_of(Random& random, const std::vector<T>& values) {
  return values[static_cast<std::size_t>(integer(random, 0, static_cast<int>(values.size()) - 1))];
}
template <typename T>
T one_of(Random& random, std::initializer_list<T> values) {
  return *std::next(values.begin(), integer(random, 0, static_cast<int>(values.size()) - 1));
}

using Json = nlohmann::ordered_json;

/// Wavelength [nm] that separates the inside of a closed box from the outside. Lights and channels inside use
/// shorter wavelengths. Lights outside use longer ones, which only the channel `kOutsideChannel` records.
inline constexpr double kMaxInside_nm = 1000;
/// Name of the channel that records only light from outside a closed box.
inline constexpr const char* kOutsideChannel = "outside";

/// Longest exposure [s] with which float can represent the sensor's counts of the brightest light, even if a
/// channel's own exposure multiplies the scene's.
inline constexpr double kMaxExposure_s = 10;

struct DrawnMaterial {
  std::string name;
  bool can_be_mixed = false;  ///< Allowed as a component of a mixture.
  bool has_interior = false;  ///< Light enters the material, so its shapes must be closed.
  /// Varies over the surface, so it does not suit meshes without texture coordinates.
  bool needs_surface_uv = false;
};

/// A scene under construction and its random generator; all lengths are in the scene's unit.
struct Drawing : Random {
  std::filesystem::path folder;
  bool closed = false;           ///< The camera is in a closed opaque box. `draw_render` may clear it.
  bool signed_response = false;  ///< A channel may have a negative response.
  double unit_m = 1;
  double size = 1;  ///< The box extends from -size to size on each axis, around `center`.
  std::array<double, 3> center{0, 0, 0};
  double brightness = 1;  ///< Order of magnitude of the numbers that describe emission.
  bool uses_probe = false;
  bool moves = false;  ///< Shapes, lights and the camera may move during the exposure.
  double open_s = 0;   ///< Time at which the shutter opens [s], on the scale of keyframes.
  double exposure_s = 1;
  std::vector<DrawnMaterial> materials;
  std::vector<Json> targets;  ///< Positions of shapes, for the camera to look at.
  Json scene;
};

/// A curve over wavelength in the scene language, with values in [0, max_value].
[[nodiscard]] Json draw_curve(Drawing& drawing, double max_value);
/// A reflectance in [0, 1], as a curve or an image. Sets `varies` to true for an image, else leaves it.
[[nodiscard]] Json draw_reflectance(Drawing& drawing, bool& varies);
/// A direction of any length, often along an axis or in a plane of two axes.
[[nodiscard]] Json draw_direction(Drawing& drawing);
/// A position in the box, at most `extent` times its half width from the center on each axis.
[[nodiscard]] Json draw_position(Drawing& drawing, double extent);

/// Adds a motion of up to three keyframes to the description of a shape, light or camera, with probability
/// 0.4 if the scene moves.
void maybe_animate(Drawing& drawing, Json& object);

/// Writes an EXR of 2 to 9 pixels per edge, whose channels have values in [low, high). This function and the
/// next two write a file to the folder and return its name. They throw Error{output} if they cannot write it.
[[nodiscard]] std::string draw_image(Drawing& drawing, const std::vector<std::string>& channels, double low,
                                     double high);
/// Writes an NPY grid of 2 to 9 densities per edge in [0, 1), many of them 0.
[[nodiscard]] std::string draw_densities(Drawing& drawing);
/// Writes a closed mesh of radius at most 1 around the origin, as PLY or OBJ.
[[nodiscard]] std::string draw_mesh_file(Drawing& drawing);

/// Each function draws one part of `scene`, under the key of its name, from what the ones before it drew.
/// They must be called once, in this order. `draw_shapes` also adds the walls of a closed box; `draw_sensor`
/// sets exposure and shutter.
void draw_materials(Drawing& drawing);
void draw_shapes(Drawing& drawing);
void draw_sensor(Drawing& drawing);
void draw_camera(Drawing& drawing);
void draw_lights(Drawing& drawing);
void draw_render(Drawing& drawing);

/// A shape of the given material without emission. Its half size is 1e-4 to 1 times that of the box. Adds its
/// position to `targets`.
[[nodiscard]] Json draw_shape(Drawing& drawing, const DrawnMaterial& drawn);
/// Emission of a light, sometimes polarised. `kind` is "area", "point" (also for spots), "sun", "directional"
/// or "environment".
[[nodiscard]] Json draw_emission(Drawing& drawing, const std::string& kind);

/// A drawn scene and what a render of it must satisfy.
struct DrawnScene {
  std::filesystem::path path;  ///< The scene file, `soak_<seed>.json`.
  /// The camera is in a closed opaque box, and `kOutsideChannel` records only light from outside.
  bool closed;
  bool signed_response;  ///< A channel may have a negative response.
};

/// Draws a scene from the whole scene language and writes it with its files to `folder`, which must exist and
/// contain no files of another scene. Their contents depend on the seed only. Throws Error{output} if a file
/// cannot be written.
[[nodiscard]] DrawnScene draw_scene(std::uint64_t seed, const std::filesystem::path& folder);

}  // namespace abbe::soak
