#include <bit>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "io/atomic_file.h"
#include "io/exr.h"
#include "validation/bench/meshes.h"
#include "validation/bench/soak/drawing.h"

namespace abbe::soak {
namespace {

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

}  // namespace

std::string draw_image(Drawing& drawing, const std::vector<std::string>& channels, double low, double high) {
  Image image;
  image.width = integer(drawing.random, 2, 9);
  image.height = integer(drawing.random, 2, 9);
  for (const std::string& name : channels) {
    image.channels.push_back({name, {}});
    for (std::size_t i = 0; i < image.pixels(); ++i)
      image.channels.back().values.push_back(static_cast<float>(uniform(drawing.random, low, high)));
  }
  const std::filesystem::path path = name_of(drawing, ".exr");
  write_exr(path, image);
  return path.filename();
}

std::string draw_densities(Drawing& drawing) {
  Random& random = drawing.random;
  const std::array<int, 3> nodes{integer(random, 2, 9), integer(random, 2, 9), integer(random, 2, 9)};
  std::string header = fmt::format("{{'descr': '<f4', 'fortran_order': False, 'shape': ({}, {}, {}), }}",
                                   nodes[0], nodes[1], nodes[2]);
  header.resize(118 - 1, ' ');  // aligns the numbers to a multiple of 64 bytes
  header += '\n';
  std::string bytes("\x93NUMPY\x01\x00", 8);
  bytes += static_cast<char>(header.size() & 0xffU);
  bytes += static_cast<char>(header.size() >> 8U);
  bytes += header;
  for (int i = nodes[0] * nodes[1] * nodes[2]; i > 0; --i) {
    const auto value = static_cast<float>(chance(random, 0.3) ? 0 : decades(random, 1e-6, 1));
    const auto bits = std::bit_cast<std::array<char, 4>>(value);
    bytes.append(bits.data(), bits.size());
  }
  const std::filesystem::path path = name_of(drawing, ".npy");
  write_atomically(path, bytes);
  return path.filename();
}

std::string draw_mesh_file(Drawing& drawing) {
  if (chance(drawing.random, 0.5)) {
    const std::filesystem::path path = name_of(drawing, ".obj");
    write_atomically(path, obj_ball(drawing.random));
    return path.filename();
  }
  const std::filesystem::path path = name_of(drawing, ".ply");
  write_ply(path, ball(drawing.random));
  return path.filename();
}

}  // namespace abbe::soak
