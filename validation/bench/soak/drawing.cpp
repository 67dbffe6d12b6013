#include "validation/bench/soak/drawing.h"

#include <algorithm>
#include <bit>
#include <numbers>

#include <fmt/format.h>

#include "io/atomic_file.h"
#include "io/exr.h"
#include "validation/bench/generated_scene.h"

namespace abbe::soak {
namespace {

Json table(Random& random, double max_value) {
  Json wavelengths = Json::array();
  Json values = Json::array();
  double nm = uniform(random, 300, 500);
  for (int i = integer(random, 2, 12); i > 0; --i) {
    wavelengths.push_back(nm);
    values.push_back(chance(random, 0.2) ? 0.0 : uniform(random, 0, max_value));
    nm += decades(random, 1e-3, 100);
  }
  return {
      {"table",
       {{"wavelength_nm", wavelengths}, {"values", values}, {"outside", one_of(random, {"clamp", "zero"})}}}};
}

Json band(Random& random, double max_value) {
  const double low = uniform(random, 300, 900);
  return {{"band", {low, std::min(1100.0, low + decades(random, 1e-3, 300))}},
          {"value", uniform(random, 0.1, 1) * max_value}};
}

Json gaussian(Random& random, double max_value) {
  return {{"gaussian",
           {{"center_nm", uniform(random, 380, 800)},
            {"fwhm_nm", decades(random, 1e-2, 300)},
            {"peak", uniform(random, 0.1, 1) * max_value}}}};
}

// A name that no other file of the scene has.
std::filesystem::path name_of(const Drawing& drawing, const char* extension) {
  for (int i = 0;; ++i) {
    std::filesystem::path path = drawing.folder / fmt::format("file{}{}", i, extension);
    if (!std::filesystem::exists(path)) return path;
  }
}

// A ball as Wavefront OBJ, with texture coordinates and with shading normals that deviate from the triangles.
std::string obj_ball(Random& random) {
  constexpr double kPi = std::numbers::pi;
  const int rows = integer(random, 2, 12);
  const int columns = integer(random, 3, 20);
  const double lean = uniform(random, 0, 0.5);
  std::string text;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      const double theta = kPi * j / rows;
      const double phi = 2 * kPi * (i % columns) / columns;
      const double x = j % rows == 0 ? 0 : std::sin(theta) * std::cos(phi);
      const double y = j % rows == 0 ? 0 : std::sin(theta) * std::sin(phi);
      text += fmt::format("v {} {} {}\nvt {} {}\nvn {} {} {}\n", x, y, std::cos(theta),
                          static_cast<double>(i) / columns, 1 - static_cast<double>(j) / rows,
                          x + uniform(random, -lean, lean), y, std::cos(theta) + 0.01);
    }
  const auto at = [columns](int j, int i) { return fmt::format("{0}/{0}/{0}", 1 + j * (columns + 1) + i); };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      if (j > 0) text += fmt::format("f {} {} {}\n", at(j, i), at(j + 1, i), at(j, i + 1));
      if (j + 1 < rows) text += fmt::format("f {} {} {}\n", at(j, i + 1), at(j + 1, i), at(j + 1, i + 1));
    }
  return text;
}

Mesh ball(Random& random) {
  Mesh mesh = make_bumpy_ball(static_cast<std::uint32_t>(integer(random, 3, 24)));
  for (Imath::V3d& vertex : mesh.vertices) vertex = (vertex - Imath::V3d(0, 1.8, 0)) / 1.56;
  return mesh;
}

// A time during the exposure of some row, or before or after it.
double keyframe_time(Drawing& drawing) {
  return drawing.open_s + drawing.exposure_s * uniform(drawing, -1, 3);
}

}  // namespace

Json draw_curve(Drawing& drawing, double max_value) {
  const int kind = integer(drawing, 0, 6);
  if (kind == 0) return table(drawing, max_value);
  if (kind == 1) return band(drawing, max_value);
  if (kind == 2) return gaussian(drawing, max_value);
  if (kind == 3) return {{"product", {band(drawing, 1), gaussian(drawing, max_value)}}};
  if (kind == 4)
    return {{"sum", {table(drawing, max_value / 2), {{"scale", 0.5}, {"of", band(drawing, max_value)}}}}};
  return uniform(drawing, 0, max_value);
}

Json draw_reflectance(Drawing& drawing, bool& varies) {
  const int kind = integer(drawing, 0, 9);
  if (kind == 0) return one_of(drawing, {0, 1});
  if (kind <= 3) return "cornell_box_walls:" + std::string(one_of(drawing, {"red", "green", "white"}));
  if (kind >= 6) return draw_curve(drawing, 1);
  varies = true;
  Json texture{{"image", draw_image(drawing, {"R", "G", "B"}, 0, 1)}};
  if (kind == 4)
    texture["rgb"] = true;
  else
    texture["weights"] = {{"R", draw_curve(drawing, 0.5)}, {"B", draw_curve(drawing, 0.5)}};
  texture["filter"] = one_of(drawing, {"bilinear", "nearest"});
  texture["wrap"] = one_of(drawing, {"repeat", "clamp"});
  texture["scale"] = {decades(drawing, 0.01, 100), -decades(drawing, 0.01, 100)};
  texture["offset"] = {uniform(drawing, -9, 9), uniform(drawing, -9, 9)};
  return texture;
}

Json draw_direction(Drawing& drawing) {
  Json direction = Json::array();
  const double length = decades(drawing, 1e-3, 1e3);
  for (int axis = 0; axis < 3; ++axis) direction.push_back(length * uniform(drawing, -1, 1));
  // Directions along an axis exercise special cases of frames and slabs.
  if (chance(drawing, 0.2)) direction[static_cast<std::size_t>(integer(drawing, 0, 1))] = 0;
  if (chance(drawing, 0.1)) direction = {0, 0, -length};
  return direction;
}

Json draw_position(Drawing& drawing, double extent) {
  Json position = Json::array();
  for (const double center : drawing.center)
    position.push_back(center + drawing.size * extent * uniform(drawing, -1, 1));
  return position;
}

std::string draw_image(Drawing& drawing, const std::vector<std::string>& channels, double low, double high) {
  Image image;
  image.width = integer(drawing, 2, 9);
  image.height = integer(drawing, 2, 9);
  for (const std::string& name : channels) {
    image.channels.push_back({name, {}});
    for (std::size_t i = 0; i < image.pixels(); ++i)
      image.channels.back().values.push_back(static_cast<float>(uniform(drawing, low, high)));
  }
  const std::filesystem::path path = name_of(drawing, ".exr");
  write_exr(path, image);
  return path.filename();
}

std::string draw_densities(Drawing& drawing) {
  const std::array<int, 3> nodes{integer(drawing, 2, 9), integer(drawing, 2, 9), integer(drawing, 2, 9)};
  std::string header = fmt::format("{{'descr': '<f4', 'fortran_order': False, 'shape': ({}, {}, {}), }}",
                                   nodes[0], nodes[1], nodes[2]);
  header.resize(118 - 1, ' ');  // aligns the numbers to a multiple of 64 bytes
  header += '\n';
  std::string bytes("\x93NUMPY\x01\x00", 8);
  bytes += static_cast<char>(header.size() & 0xffU);
  bytes += static_cast<char>(header.size() >> 8U);
  bytes += header;
  for (int i = nodes[0] * nodes[1] * nodes[2]; i > 0; --i) {
    const auto value = static_cast<float>(chance(drawing, 0.3) ? 0 : decades(drawing, 1e-6, 1));
    const auto bits = std::bit_cast<std::array<char, 4>>(value);
    bytes.append(bits.data(), bits.size());
  }
  const std::filesystem::path path = name_of(drawing, ".npy");
  write_atomically(path, bytes);
  return path.filename();
}

std::string draw_mesh_file(Drawing& drawing) {
  if (chance(drawing, 0.5)) {
    const std::filesystem::path path = name_of(drawing, ".obj");
    write_atomically(path, obj_ball(drawing));
    return path.filename();
  }
  const std::filesystem::path path = name_of(drawing, ".ply");
  write_ply(path, ball(drawing));
  return path.filename();
}

void maybe_animate(Drawing& drawing, Json& object) {
  if (!drawing.moves || !chance(drawing, 0.4)) return;
  std::vector<double> times;
  for (int i = integer(drawing, 1, 3); i > 0; --i) times.push_back(keyframe_time(drawing));
  std::ranges::sort(times);
  // Rotations are about the origin. Only a box around the origin stays near its position.
  const bool turns = drawing.center == std::array<double, 3>{0, 0, 0} && chance(drawing, 0.5);
  const Json axis = draw_direction(drawing);
  for (const double time : times) {
    Json keyframe{{"time_s", time}};
    if (turns) keyframe["rotate"] = {{"axis", axis}, {"deg", uniform(drawing, -20, 20)}};
    Json offset = Json::array();
    for (int i = 0; i < 3; ++i) offset.push_back(drawing.size * decades(drawing, 1e-6, 0.05));
    keyframe["translate"] = offset;
    object["motion"]["keyframes"].push_back(keyframe);
  }
}

}  // namespace abbe::soak
