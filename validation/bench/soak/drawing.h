#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "validation/bench/soak/random.h"

namespace abbe::soak {

using Json = nlohmann::ordered_json;

/// A closed box keeps the light beyond it out: what is inside emits and is seen below this wavelength [nm]
/// only, what is outside shines above it, where one channel of this name looks.
inline constexpr double kInsideBelow = 1000;
inline constexpr const char* kOutsideChannel = "outside";

/// Longest exposure, that floats hold what sensors count of the brightest light, also where a channel's own
/// multiplies the scene's.
inline constexpr double kLongest_s = 10;

/// A material by name, and which shapes may be made of it.
struct DrawnMaterial {
  std::string name;
  bool mixes = false;             ///< It may be part of a mixture.
  bool entered = false;           ///< Light enters it, so its shapes must be closed.
  bool needs_surface_uv = false;  ///< It varies over the surface: not for meshes without coordinates.
};

/// A scene that is being drawn, all lengths in its own unit.
struct Drawing {
  Random random;
  std::filesystem::path folder;  ///< Of the files beside it.
  bool closed = false;           ///< The camera is in a closed opaque box.
  bool signed_response = false;  ///< A channel may count negatively.
  double unit_m = 1;
  double size = 1;  ///< The box reaches from -size to size on each axis, around `middle`.
  std::array<double, 3> middle{0, 0, 0};
  double brightness = 1;  ///< Order of magnitude of radiances.
  bool metered = false;   ///< A meter in place of a camera.
  bool moves = false;     ///< Shapes, lamps and the camera may move while the shutter is open:
  double opens_s = 0;     ///< from then on,
  double exposure_s = 1;  ///< for so long.
  std::vector<DrawnMaterial> matter;
  std::vector<Json> targets;  ///< Where shapes stand, for the camera to look at.
  Json scene;
};

/// A curve of the scene language with values in [0, most].
[[nodiscard]] Json draw_curve(Drawing& drawing, double most);
/// A reflectance in [0, 1], as a curve or an image. Sets `varies` for an image.
[[nodiscard]] Json draw_reflectance(Drawing& drawing, bool& varies);
/// A direction of any length, often along an axis or in a plane of axes.
[[nodiscard]] Json draw_direction(Drawing& drawing);
/// A place at most `share` of the box's half width from its middle, on each axis.
[[nodiscard]] Json draw_place(Drawing& drawing, double share);

/// Lets a shape, lamp or camera that is described so far move, now and then where things do.
void let_move(Drawing& drawing, Json& what);

/// Each writes a file of drawn content to the folder and returns its name. Throws Error{output}.
/// An image of a few pixels, whose channels have values in [low, high).
[[nodiscard]] std::string draw_image(Drawing& drawing, const std::vector<std::string>& channels, double low,
                                     double high);
/// A grid of densities in [0, 1), many of them 0.
[[nodiscard]] std::string draw_densities(Drawing& drawing);
/// A closed mesh of radius 1 around the origin, as PLY or OBJ.
[[nodiscard]] std::string draw_mesh_file(Drawing& drawing);

/// Draw one part of the scene each; they build on each other in this order.
void draw_materials(Drawing& drawing);
void draw_shapes(Drawing& drawing);
void draw_sensor(Drawing& drawing);
void draw_camera(Drawing& drawing);
void draw_lights(Drawing& drawing);
void draw_render(Drawing& drawing);

/// One shape of a material without emission, between 1e-4 and once the size of the box large.
[[nodiscard]] Json draw_shape(Drawing& drawing, const DrawnMaterial& matter);
/// An emission for something of that kind: "area", "place" (point and spot), "sun", "directional" or
/// "environment".
[[nodiscard]] Json draw_emission(Drawing& drawing, const std::string& kind);

}  // namespace abbe::soak
